// SPDX-License-Identifier: MIT
// The models of the benchmark: Lorenz, the Keller-Miksis bubble and the pressure relief valve.
#pragma once

#include <myriad/model.hpp>

#include "benchmarks/cpu_peers/relief_valve/model.hpp"
#include "problems/keller_miksis.hpp"
#include "problems/lorenz.hpp"

namespace gpu_ensembles {

using problems::eight_thirds, problems::lorenz_with;

/// The value for 8/3 in the paper's tutorial.
struct rounded_down {
    static constexpr double b = 2.666;
};
using lorenz = problems::fused_lorenz;
using tutorial_lorenz = lorenz_with<rounded_down>;

/// The bubble with branch-free functions; stores each phase's largest radius.
struct keller_miksis : problems::keller_miksis_with_peak {
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& u, const auto& p) {
        using myriad::powr, myriad::reciprocal, myriad::sincospi;
        // None of these has a branch, so that they overlap; the angles depend only on the time.
        const auto first = sincospi(R(2.0 * t)), second = sincospi(R(2.0 * p[C11] * t + p[C12]));
        const R inverse = reciprocal(u[y]);
        const R power = powr(u[y], -p[C10]);
        const R numerator = (p[C0] + p[C1] * u[v]) * power - p[C2] * (1.0 + p[C9] * u[v]) - p[C3] * inverse -
                            p[C4] * u[v] * inverse - (1.5 - 0.5 * p[C9] * u[v]) * u[v] * u[v] -
                            (p[C5] * first.sine + p[C6] * second.sine) * (1.0 + p[C9] * u[v]) -
                            u[y] * (p[C7] * first.cosine + p[C8] * second.cosine);
        const R denominator = u[y] - p[C9] * u[y] * u[v] + p[C4] * p[C9];
        return {u[v], numerator * reciprocal(denominator)};
    }
};

using dormand_prince_8_pi = myriad::controlled<myriad::dormand_prince_8, myriad::pi_control>;

/// The valve of the CPU benchmark.
using relief_valve = cpu_peers::relief_valve_model;

}  // namespace gpu_ensembles
