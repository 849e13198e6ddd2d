// SPDX-License-Identifier: MIT
// The magnetic pendulum, after Motter, Gruiz, Karolyi and Tel, Phys. Rev. Lett. 111 (2013) 194101: a bob that hangs over
// three magnets at the corners of a triangle. Lengths are in sides of the triangle, times such that a magnet has strength one.
#pragma once

#include <myriad/model.hpp>

// snippet: model
/// x'' = -omega^2 x - damping x' + sum over the magnets of (x_i - x) / D_i^3, D_i^2 = |x_i - x|^2 + height^2, in the plane.
struct magnetic_pendulum {
    enum state { x, y, u, v, n_state };
    enum shared { omega, damping, height, barrier, n_shared };
    static constexpr int magnets = 3;
    static constexpr double x_1 = 0.57735026918962576, x_23 = -x_1 / 2, y_2 = 0.5,
                            y_3 = -0.5;  // the first is at (x_1, 0)

    template <class R>
    MYRIAD_FUNCTION static R inverse_distance(R dx, R dy, R height) {
        return R(1) / myriad::sqrt(dx * dx + dy * dy + height * height);
    }
    // Mirrored in the x axis the second and third term change places: added first, they give the same bits then.
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        const R h = R(p.shared[height]), stiffness = R(p.shared[omega] * p.shared[omega]);
        const R dx_1 = R(x_1) - s[x], dx_23 = R(x_23) - s[x], dy_2 = R(y_2) - s[y], dy_3 = R(y_3) - s[y];
        const R n_1 = inverse_distance(dx_1, -s[y], h), n_2 = inverse_distance(dx_23, dy_2, h),
                n_3 = inverse_distance(dx_23, dy_3, h);
        const R w_1 = n_1 * n_1 * n_1, w_2 = n_2 * n_2 * n_2, w_3 = n_3 * n_3 * n_3;
        return {s[u], s[v], dx_1 * w_1 + dx_23 * (w_2 + w_3) - stiffness * s[x] - p.shared[damping] * s[u],
                (dy_2 * w_2 + dy_3 * w_3) - s[y] * w_1 - stiffness * s[y] - p.shared[damping] * s[v]};
    }
    template <class R>
    MYRIAD_FUNCTION static R potential(R at_x, R at_y, R omega, R h) {
        return R(0.5) * omega * omega * (at_x * at_x + at_y * at_y) - inverse_distance(R(x_1) - at_x, -at_y, h) -
               (inverse_distance(R(x_23) - at_x, R(y_2) - at_y, h) +
                inverse_distance(R(x_23) - at_x, R(y_3) - at_y, h));
    }
    /// Friction only takes energy away: below the barrier between the wells, the bob stays in the one where it is.
    template <class R>
    MYRIAD_FUNCTION static myriad::mask_of<R> after_step(auto& lane) {
        const auto& s = lane.y;
        const R kinetic = R(0.5) * (s[u] * s[u] + s[v] * s[v]);
        return kinetic + potential<R>(s[x], s[y], R(lane.shared[omega]), R(lane.shared[height])) < lane.shared[barrier];
    }
};
// end of snippet
