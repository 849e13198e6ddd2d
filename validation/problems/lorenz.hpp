// SPDX-License-Identifier: MIT
// Lorenz' equations, and the same with a tangent for the largest Lyapunov exponent.
#pragma once

#include <myriad/model.hpp>

#include "problems/lorenz.hpp"

namespace validation {

using lorenz = problems::factored_lorenz;

/// Lorenz' equations with a tangent (u, v, w), normalised at the end of each phase.
struct lorenz_tangent : lorenz {
    enum state { x, y, z, u, v, w, n_state };
    enum accessory { growth, n_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {R(10) * (s[y] - s[x]),
                s[x] * (p[rho] - s[z]) - s[y],
                s[x] * s[y] - R(beta<R>) * s[z],
                R(10) * (s[v] - s[u]),
                s[u] * (p[rho] - s[z]) - s[v] - s[x] * s[w],
                s[u] * s[y] + s[x] * s[v] - R(beta<R>) * s[w]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        if (lane.phase == 0) lane.accessory[growth] = 0;
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) {
        const auto length = myriad::sqrt(lane.y[u] * lane.y[u] + lane.y[v] * lane.y[v] + lane.y[w] * lane.y[w]);
        lane.y[u] /= length;
        lane.y[v] /= length;
        lane.y[w] /= length;
        lane.accessory[growth] += myriad::log(length);
    }
};

}  // namespace validation
