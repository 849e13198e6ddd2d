// SPDX-License-Identifier: MIT
// The Duffing oscillator by a hand-written scalar loop with Myriad's algorithm.
#include "../peer.hpp"
#include "equations.hpp"

namespace cpu_peers::duffing {

outcome run_loop(const sweep& work) {
    return run_instances<n>(work, [&](double(&y)[n], auto&& parameter_of, std::int64_t& accepted) {
        const double k = parameter_of(0);
        const auto f = [k](double t, const double(&u)[n], double(&du)[n]) __attribute__((always_inline)) {
            slopes(t, u[0], u[1], k, du[0], du[1]);
        };
        for (int phase = 0; phase < work.phases; ++phase)
            if (!integrate_phase(f, y, period, work.tolerance, accepted, [](const double(&)[n]) {}))
                return ending::failed;
        return ending::completed;
    });
}

}  // namespace cpu_peers::duffing
