// SPDX-License-Identifier: MIT
// The magnetic pendulum, after Motter, Gruiz, Karolyi and Tel, Phys. Rev. Lett. 111 (2013) 194101: a bob that hangs
// over three magnets at the corners of a triangle. The unit of length is the triangle's side; that of time gives a
// magnet strength one.
#pragma once

#include <myriad/model.hpp>

// snippet: model
/// In the plane, x'' = -omega^2 x - damping x' + sum over the magnets of (x_i - x) / D_i^3, D_i^2 = |x_i - x|^2 +
/// height^2.
struct magnetic_pendulum {
    enum state { x, y, u, v, n_state };
    enum shared { omega, damping, height, barrier, n_shared };
    // The magnets are at (x_1, 0), (x_23, half) and (x_23, -half).
    static constexpr double x_1 = 0.57735026918962576, x_23 = -x_1 / 2, half = 0.5;

    template <class R>
    MYRIAD_FUNCTION static R inverse_distance(R dx, R dy, R height) {
        return R(1) / myriad::sqrt(dx * dx + dy * dy + height * height);
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 3> inverse_distances(R at_x, R at_y, R height) {
        const R dx_23 = R(x_23) - at_x;
        return {inverse_distance(R(x_1) - at_x, at_y, height), inverse_distance(dx_23, R(half) - at_y, height),
                inverse_distance(dx_23, R(half) + at_y, height)};
    }
    // Mirrored in the x axis, with magnets 2 and 3 exchanged, these sums have the same bits, however they are fused.
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        const myriad::vec<R, 3> n = inverse_distances<R>(s[x], s[y], R(p.shared[height]));
        const R w_1 = n[0] * n[0] * n[0], w_2 = n[1] * n[1] * n[1], w_3 = n[2] * n[2] * n[2];
        const R stiffness = w_1 + (w_2 + w_3) + p.shared[omega] * p.shared[omega];
        return {s[u], s[v], R(x_1) * w_1 + R(x_23) * (w_2 + w_3) - stiffness * s[x] - p.shared[damping] * s[u],
                R(half) * (w_2 - w_3) - stiffness * s[y] - p.shared[damping] * s[v]};
    }
    template <class R>
    MYRIAD_FUNCTION static R potential(R at_x, R at_y, R omega, R height) {
        const myriad::vec<R, 3> n = inverse_distances<R>(at_x, at_y, height);
        return R(0.5) * omega * omega * (at_x * at_x + at_y * at_y) - (n[0] + (n[1] + n[2]));
    }
    /// Friction only removes energy: below the barrier between the wells, the bob stays in its well.
    template <class R>
    MYRIAD_FUNCTION static myriad::mask_of<R> after_step(auto& lane) {
        const auto& s = lane.y;
        const R kinetic = R(0.5) * (s[u] * s[u] + s[v] * s[v]);
        return kinetic + potential<R>(s[x], s[y], R(lane.shared[omega]), R(lane.shared[height])) < lane.shared[barrier];
    }
};
// end of snippet
