// SPDX-License-Identifier: MIT
// The Keller-Miksis bubble by a hand-written scalar loop with Myriad's algorithm.
#include "../peer.hpp"
#include "equations.hpp"

namespace cpu_peers::keller_miksis {

outcome run_loop(const sweep& work) {
    return run_instances<n>(work, [&](double(&y)[n], auto&& parameter_of, std::int64_t& accepted) {
        double C[constants];
        for (int c = 0; c < constants; ++c) C[c] = parameter_of(c);
        const auto f = [&C](double t, const double(&u)[n], double(&du)[n]) __attribute__((always_inline)) {
            slopes(t, u[0], u[1], C, du[0], du[1]);
        };
        for (int phase = 0; phase < work.phases; ++phase) {
            double y_max = y[0];
            const auto keep_largest = [&](const double(&u)[n]) { y_max = std::max(y_max, u[0]); };
            if (!integrate_phase(f, y, 1.0, work.tolerance, accepted, keep_largest)) return ending::failed;
            asm volatile("" : : "x"(y_max));  // makes the result count as used
        }
        return ending::completed;
    });
}

}  // namespace cpu_peers::keller_miksis
