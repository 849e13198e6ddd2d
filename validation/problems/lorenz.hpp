// SPDX-License-Identifier: MIT
// Lorenz' equations, and the same with a tangent for the largest Lyapunov exponent.
#pragma once

#include <myriad/model.hpp>

namespace validation {

/// The constant in the precision of R.
template <class R>
inline constexpr auto b = static_cast<myriad::real_of<R>>(8.0 / 3.0);

/// x' = 10 (y - x), y' = rho x - y - x z, z' = x y - 8/3 z.
struct lorenz {
    enum state { x, y, z, n_state };
    enum parameter { rho, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {R(10) * (s[y] - s[x]), s[x] * (p[rho] - s[z]) - s[y], s[x] * s[y] - R(b<R>) * s[z]};
    }
};

/// Lorenz' equations with a tangent (u, v, w), normalised at the end of each phase.
struct lorenz_tangent {
    enum state { x, y, z, u, v, w, n_state };
    enum parameter { rho, n_parameter };
    enum accessory { growth, n_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {R(10) * (s[y] - s[x]),
                s[x] * (p[rho] - s[z]) - s[y],
                s[x] * s[y] - R(b<R>) * s[z],
                R(10) * (s[v] - s[u]),
                s[u] * (p[rho] - s[z]) - s[v] - s[x] * s[w],
                s[u] * s[y] + s[x] * s[v] - R(b<R>) * s[w]};
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
