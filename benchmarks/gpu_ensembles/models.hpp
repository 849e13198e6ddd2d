// SPDX-License-Identifier: MIT
// The models that the benchmark integrates: Lorenz, the Keller-Miksis bubble and the pressure relief valve.
#pragma once

#include <myriad/model.hpp>

#include "benchmarks/cpu_peers/relief_valve/model.hpp"

namespace gpu_ensembles {

/// x' = 10 (y - x), y' = rho x - y - x z, z' = x y - b z; `Constant::b` is 8/3 or what the paper's tutorial writes for it.
template <class Constant>
struct lorenz_with {
    enum state { x, y, z, n_state };
    enum parameter { rho, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        // Six floating-point instructions, one of each line's two fused.
        return {R(10) * (s[y] - s[x]), myriad::fma(s[x], p[rho] - s[z], -s[y]),
                myriad::fma(s[x], s[y], -(R(Constant::b) * s[z]))};
    }
};
struct eight_thirds {
    static constexpr double b = 8.0 / 3;
};
struct rounded_down {
    static constexpr double b = 2.666;
};
using lorenz = lorenz_with<eight_thirds>;
using tutorial_lorenz = lorenz_with<rounded_down>;

/// The dimensionless radius y and its slope v over time in periods of the first forcing; keeps each phase's largest radius.
struct keller_miksis {
    static constexpr bool accessories_are_outputs = true;
    enum state { y, v, n_state };
    enum parameter { C0, C1, C2, C3, C4, C5, C6, C7, C8, C9, C10, C11, C12, n_parameter };
    enum accessory { y_max, n_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& u, const auto& p) {
        using myriad::powr, myriad::reciprocal, myriad::sincospi;
        // None of these has a branch, so that they overlap; the angles wait for nothing but the time.
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

    MYRIAD_FUNCTION static void initialise(auto& lane) { lane.accessory[y_max] = lane.y[y]; }

    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        lane.accessory[y_max] = myriad::max(lane.accessory[y_max], lane.y[y]);
    }
};

using dormand_prince_8_pi = myriad::controlled<myriad::dormand_prince_8, myriad::pi_control>;

/// The valve of the benchmark on CPUs.
using relief_valve = cpu_peers::relief_valve_model;

}  // namespace gpu_ensembles
