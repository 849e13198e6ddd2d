// SPDX-License-Identifier: MIT
// The Keller-Miksis bubble as a Myriad model; keeps the largest radius of each phase.
#pragma once

#include <myriad/model.hpp>

namespace cpu_peers {

/// The dimensionless radius y and its slope v over time in periods of the first forcing.
struct keller_miksis_model {
    static constexpr bool accessories_are_outputs = true;
    enum state { y, v, n_state };
    enum parameter { C0, C1, C2, C3, C4, C5, C6, C7, C8, C9, C10, C11, C12, n_parameter };
    enum accessory { y_max, n_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& u, const auto& p) {
        using myriad::cospi, myriad::exp2, myriad::fma, myriad::log2, myriad::sinpi;
        const R first = 2.0 * t, second = fma(2.0 * p[C11], R(t), p[C12]);
        const R inverse = 1.0 / u[y], mach = p[C9] * u[v], approach = 1.0 + mach;
        // Half the instructions of pow, and a digit less where the radius changes by orders of magnitude.
        const R gas = fma(p[C1], u[v], p[C0]) * exp2(-p[C10] * log2(u[y]));
        const R at_wall = fma(fma(p[C4], u[v], p[C3]), inverse, fma(R(-0.5), mach, R(1.5)) * u[v] * u[v]);
        const R driving = fma(p[C5], sinpi(first), fma(p[C6], sinpi(second), p[C2])) * approach;
        const R waves = u[y] * fma(p[C7], cospi(first), p[C8] * cospi(second));
        const R denominator = fma(u[y], 1.0 - mach, p[C4] * p[C9]);
        return {u[v], (gas - at_wall - driving - waves) / denominator};
    }

    MYRIAD_FUNCTION static void initialise(auto& lane) { lane.accessory[y_max] = lane.y[y]; }

    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        lane.accessory[y_max] = myriad::max(lane.accessory[y_max], lane.y[y]);
    }
};

}  // namespace cpu_peers
