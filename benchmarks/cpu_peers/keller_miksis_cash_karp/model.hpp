// SPDX-License-Identifier: MIT
// The Keller-Miksis bubble as a Myriad model; keeps the largest radius of each phase.
#pragma once

#include <myriad/model.hpp>

namespace cpu_peers {

/// The dimensionless radius y and its slope v over time in periods of the first forcing.
struct keller_miksis_model {
    enum state { y, v, n_state };
    enum parameter { C0, C1, C2, C3, C4, C5, C6, C7, C8, C9, C10, C11, C12, n_parameter };
    enum accessory { y_max, n_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& u, const auto& p) {
        using myriad::cospi, myriad::pow, myriad::sinpi;
        const R first = 2.0 * t, second = 2.0 * p[C11] * t + p[C12];
        const R inverse = 1.0 / u[y];
        const R numerator = (p[C0] + p[C1] * u[v]) * pow(u[y], -p[C10]) - p[C2] * (1.0 + p[C9] * u[v]) -
                            p[C3] * inverse - p[C4] * u[v] * inverse - (1.5 - 0.5 * p[C9] * u[v]) * u[v] * u[v] -
                            (p[C5] * sinpi(first) + p[C6] * sinpi(second)) * (1.0 + p[C9] * u[v]) -
                            u[y] * (p[C7] * cospi(first) + p[C8] * cospi(second));
        const R denominator = u[y] - p[C9] * u[y] * u[v] + p[C4] * p[C9];
        return {u[v], numerator / denominator};
    }

    MYRIAD_FUNCTION static void initialise(auto& lane) { lane.accessory[y_max] = lane.y[y]; }

    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        lane.accessory[y_max] = myriad::max(lane.accessory[y_max], lane.y[y]);
    }
};

}  // namespace cpu_peers
