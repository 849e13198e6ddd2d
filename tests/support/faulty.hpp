// SPDX-License-Identifier: MIT
// Models that fail: right-hand sides and hooks that return NaN, solutions that blow up, slopes that jump.
#pragma once

#include <limits>

#include <myriad/methods.hpp>
#include <myriad/model.hpp>

#include "tests/support/problems.hpp"

namespace faulty {

template <class R>
inline constexpr myriad::real_of<R> not_a_number = std::numeric_limits<myriad::real_of<R>>::quiet_NaN();
template <class R>
inline constexpr myriad::real_of<R> infinity = std::numeric_limits<myriad::real_of<R>>::infinity();

/// y' = -rate y, and NaN (kind 0) or infinity (kind 1) in the second component once t has passed a time.
struct clock_fault {
    enum state { y0, y1, n_state };
    enum parameter { rate, last_good, kind, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> rhs(auto t, const myriad::vec<R, 2>& y, const auto& p) {
        const R bad = myriad::select(p[kind] > R(0), R(infinity<R>), R(not_a_number<R>));
        return {-(p[rate] * y[y0]), myriad::select(t > p[last_good], bad, y[y0])};
    }
};

/// y' = 1, and NaN where y > limit: the domain of a square root.
struct domain_fault {
    enum state { y0, n_state };
    enum parameter { limit, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto& p) {
        const R root = myriad::sqrt(p[limit] - y[y0]);
        return myriad::vec<R, 1>{R(1) + (root - root)};
    }
};

/// y' = speed, and NaN above (side > 0) or below (side < 0) the limit.
struct cliff {
    enum state { y0, n_state };
    enum parameter { limit, speed, side, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto& p) {
        // A NaN state is not within the limit either.
        return myriad::vec<R, 1>{myriad::select((y[y0] - p[limit]) * p[side] <= R(0), p[speed], R(not_a_number<R>))};
    }
};

/// y' = 1, and NaN above 1, written so that a NaN state has a finite slope.
struct open_cliff {
    enum state { y0, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{myriad::select(y[y0] > R(1), R(not_a_number<R>), R(1))};
    }
};

/// Runge's midpoint rule, whose first stage does not enter its solution.
struct midpoint_rule {
    static constexpr int stages = 2;
    static constexpr int order = 2;
    static constexpr int embedded_order = 0;
    static constexpr bool first_same_as_last = false;

    static constexpr myriad::explicit_tableau<stages> tableau() {
        myriad::explicit_tableau<stages> t{};
        t.c = {0, 0.5};
        t.a[1] = {0.5};
        t.b = {0, 1};
        return t;
    }
};

/// x' = v, v' = -x with the unit circle as its limit cycle, and NaN beyond |x| = limit, slightly outside it: the stages
/// of long steps leave the domain twice per turn. Ends when t has passed `stop`.
struct guarded {
    enum state { x, v, n_state };
    enum parameter { limit, stop, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> rhs(auto, const myriad::vec<R, 2>& y, const auto& p) {
        const R root = myriad::sqrt(p[limit] * p[limit] - y[x] * y[x]);
        return {y[v] + (root - root), (R(1) - y[x] * y[x] - y[v] * y[v]) * y[v] - y[x]};
    }
    MYRIAD_FUNCTION static myriad::action after_step(auto& lane) {
        return lane.t >= lane.parameter[stop] ? myriad::action::end_phase : myriad::action::proceed;
    }
};

/// y' = y^2, y(0) = 1: 1 / (1 - t), with a pole at 1.
struct blow_up {
    enum state { y0, n_state };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{y[y0] * y[y0]};
    }
};

/// y' = 0 before a time and 1 after it.
struct slope_jump {
    enum state { y0, n_state };
    enum parameter { time, n_parameter };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto t, const myriad::vec<R, 1>&, const auto& p) {
        return myriad::vec<R, 1>{myriad::select(t < p[time], R(0), R(1))};
    }
};

/// y' = 1, with hooks that write NaN into the state; the integer accessory selects the hook.
struct hook_fault : problems::uniform {
    enum parameter { time, n_parameter };
    enum integer_accessory { which, finished, n_integer_accessory };
    enum hooks { none, in_initialise, in_after_step, in_finalise };

    MYRIAD_FUNCTION static void spoil(auto& lane, int hook) {
        if (lane.integer_accessory[which] == hook && lane.t >= lane.parameter[time])
            lane.y[y0] = not_a_number<decltype(+lane.t)>;
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) { spoil(lane, in_initialise); }
    MYRIAD_FUNCTION static void after_step(auto& lane) { spoil(lane, in_after_step); }
    MYRIAD_FUNCTION static void finalise(auto& lane) {
        spoil(lane, in_finalise);
        lane.integer_accessory[finished] += 1;
    }
};

}  // namespace faulty
