// SPDX-License-Identifier: MIT
// The forced Duffing oscillator with two wells, and twice the same with a tangent vector: linearised by hand, and by
// the library. Equation and its route to chaos: Guckenheimer and Holmes, Nonlinear Oscillations, Dynamical Systems, and
// Bifurcations of Vector Fields (Springer 1983), section 2.2. All quantities are dimensionless.
#pragma once

#include <myriad/model.hpp>
#include <myriad/tangent.hpp>

// snippet: library
/// x'' + k x' - x + x^3 = B cos t.
struct forced_duffing {
    enum state { x, v, n_state };
    enum parameter { k, B, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        const auto [sine, cosine] = myriad::sincos(t);
        return {y[v], y[x] - y[x] * y[x] * y[x] - p[k] * y[v] + p[B] * cosine};
    }
};
using library_tangent = myriad::with_tangents<forced_duffing, 1>;
// end of snippet

// snippet: hand
/// The same with its linearisation, a'' + k a' - a + 3 x^2 a = 0: at the end of each period (a, b) is normalised, and
/// the logarithm of its growth is summed from phase `transient` on.
struct hand_tangent {
    enum state { x, v, a, b, n_state };
    enum parameter { k, B, n_parameter };
    enum shared_integer { transient, n_shared_integer };
    enum accessory { growth, n_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        const auto [sine, cosine] = myriad::sincos(t);
        return {y[v], y[x] - y[x] * y[x] * y[x] - p[k] * y[v] + p[B] * cosine, y[b],
                y[a] - R(3) * y[x] * y[x] * y[a] - p[k] * y[b]};
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) {
        const auto length = myriad::hypot(lane.y[a], lane.y[b]);
        lane.y[a] /= length;
        lane.y[b] /= length;
        if (lane.phase >= lane.shared_integer[transient]) lane.accessory[growth] += myriad::log(length);
    }
};
// end of snippet
