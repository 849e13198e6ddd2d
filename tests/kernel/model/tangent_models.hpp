// SPDX-License-Identifier: MIT
// Models with known Lyapunov exponents or tangents, and one with every hook, for the tests of tangent dynamics.
#pragma once

#include <myriad/kernel/model/tangent.hpp>
#include <myriad/model.hpp>

#include "tests/support/problems.hpp"

namespace tangents {

/// Lorenz' equations: their divergence is -41/3.
using problems::lorenz;
using lorenz_spectrum = myriad::with_tangents<lorenz, 3>;

using problems::roessler;

/// Roessler's equations with c = 10, whose contraction is stronger and less even.
struct strong_roessler : roessler {
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return {-s[y] - s[z], s[x] + R(0.2) * s[y], R(0.2) + s[z] * (s[x] - R(10))};
    }
};
using strong_roessler_spectrum = myriad::with_tangents<strong_roessler, 3>;

/// A spiral in (x, y) that drives z: eigenvalues growth +- i frequency, and decay.
struct spiral {
    enum state { x, y, z, n_state };
    enum parameter { growth, frequency, decay, coupling, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {p[growth] * s[x] - p[frequency] * s[y], p[frequency] * s[x] + p[growth] * s[y],
                p[decay] * s[z] + p[coupling] * s[x]};
    }
};
using spiral_spectrum = myriad::with_tangents<spiral, 3>;

using problems::van_der_pol;
using van_der_pol_spectrum = myriad::with_tangents<van_der_pol, 2>;

/// A ball on a table at amplitude sin t that throws it back with restitution r, under linear drag, with every hook.
struct table {
    enum state { x, v, n_state };
    enum parameter { r, n_parameter };
    enum shared { amplitude, drag, n_shared };
    enum shared_integer { bounces_allowed, n_shared_integer };
    enum accessory { highest, path, x_start, n_accessory };
    enum integer_accessory { bounces, phases, n_integer_accessory };
    enum event { impact, apex, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], R(-1) - p.shared[drag] * y[v]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[x] - p.shared[amplitude] * myriad::sin(t), y[v]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        if (lane.phase == 0) {
            lane.accessory[highest] = lane.y[x];
            lane.accessory[path] = 0;
            lane.integer_accessory[bounces] = 0;
            lane.integer_accessory[phases] = 0;
        }
        lane.accessory[x_start] = lane.y[x];
    }
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        lane.accessory[path] += myriad::abs(lane.h * lane.y[v]);
    }
    MYRIAD_FUNCTION static myriad::action after_event(int event, auto& lane) {
        if (event == apex) {
            lane.accessory[highest] = myriad::max(lane.accessory[highest], lane.y[x]);
            return myriad::action::proceed;
        }
        const auto wall = lane.shared[amplitude] * myriad::cos(lane.t);
        lane.y[x] = lane.shared[amplitude] * myriad::sin(lane.t);
        lane.y[v] = wall - lane.parameter[r] * (lane.y[v] - wall);
        lane.integer_accessory[bounces] += 1;
        return lane.integer_accessory[bounces] == lane.shared_integer[bounces_allowed] ? myriad::action::end_instance
                                                                                       : myriad::action::proceed;
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) { lane.integer_accessory[phases] += 1; }
};

/// The same, with accessories that rhs and events do not see.
struct recording_table : table {
    static constexpr bool accessories_are_outputs = true;
};
using table_spectrum = myriad::with_tangents<recording_table, 2>;

/// x' = 1 until x passes zero and `speed` from there on; each phase ends with x -> 3 x, a scalar after_step stops at x
/// = 9.
struct gear {
    enum state { x, n_state };
    enum parameter { speed, n_parameter };
    enum integer_accessory { high, n_integer_accessory };
    enum event { shift, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return myriad::vec<R, n_state>{myriad::select(p.integer_accessory[high] == 1, p[speed], R(1))};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[x]};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) { lane.integer_accessory[high] = 1; }
    MYRIAD_FUNCTION static myriad::action after_step(auto& lane) {
        return lane.y[x] >= 9 ? myriad::action::end_phase : myriad::action::proceed;
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) { lane.y[x] = lane.y[x] * 3; }
};

/// x = x(0) - 1 + (t - 1)^2, lowest at t = 1, and w' = w, so that tangents grow.
struct dip {
    enum state { x, w, n_state };
    enum integer_accessory { crossings, n_integer_accessory };
    enum event { zero, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto&) {
        return {R(2) * (t - R(1)), y[w]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[x]};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) { lane.integer_accessory[crossings] += 1; }
};

}  // namespace tangents
