// SPDX-License-Identifier: MIT
// Compiles the kernels with dense output of the models that jump and turn.
#include <myriad/instantiate.hpp>

#include "tests/output/models.hpp"

MYRIAD_INSTANTIATE(output::bouncing, myriad::dense<myriad::runge_kutta_4>, myriad::dense<myriad::cash_karp>,
                   myriad::dense<myriad::tsitouras_5>)
MYRIAD_INSTANTIATE(output::retargeted, myriad::dense<myriad::runge_kutta_4>, myriad::dense<myriad::cash_karp>)

namespace output {

template <class Model, class Method>
myriad::run_statistics run_one_lane(const myriad::kernel_arguments<Model, double>& arguments,
                                    const myriad::run_options& options) {
    return myriad::run_packs<Model, Method, double, 0>(arguments, options);
}

template myriad::run_statistics run_one_lane<bouncing, myriad::dense<myriad::cash_karp>>(
    const myriad::kernel_arguments<bouncing, double>&, const myriad::run_options&);

}  // namespace output
