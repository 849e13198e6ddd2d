// SPDX-License-Identifier: MIT
// The loop over packs with the models' flags and as many batches as Myriad uses: Myriad's time is checked against it.
#include <myriad/kernel/methods/runge_kutta_4.hpp>
#include <myriad/openmp/run.hpp>

#include "pack_loop.hpp"
#include "problems/lorenz.hpp"

namespace cpu_peers::lorenz {

outcome run_packs_as_models(const sweep& work) {
    return run_pack_loop<myriad::detail::default_batches<problems::fused_lorenz, myriad::runge_kutta_4>()>(work);
}

}  // namespace cpu_peers::lorenz
