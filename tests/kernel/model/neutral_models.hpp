// SPDX-License-Identifier: MIT
// Neutral equations, which read the slope that a state had, with closed solutions.
#pragma once

#include <myriad/model.hpp>

namespace neutral {

/// y' + y = c (y'(t - 1) + y(t - 1)), y = 1 before: the left side is c^k in the k-th interval.
struct fading {
    enum state { y, n_state };
    enum parameter { c, n_parameter };
    enum delayed { before, slope_before, n_delayed };

    MYRIAD_FUNCTION static int delayed_state(int) { return y; }
    MYRIAD_FUNCTION static bool is_delayed_slope(int j) { return j == slope_before; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const auto&) {
        return R(1);
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& now, const auto& p) {
        return {p[c] * (p.delayed[slope_before] + p.delayed[before]) - now[y]};
    }
};

/// y' = y'(t - 1), y = t^2 before: the slope goes from -2 to 0 in each interval, and the event is in its middle.
struct sawtooth {
    enum state { y, n_state };
    enum accessory { last, sum_of_lateness, found, n_accessory };
    enum delayed { slope_before, n_delayed };
    enum event { half, n_event };

    MYRIAD_FUNCTION static int delayed_state(int) { return y; }
    MYRIAD_FUNCTION static bool is_delayed_slope(int) { return true; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const auto&) {
        return R(1);
    }
    template <class R>
    MYRIAD_FUNCTION static R history(int, const R& t, const auto&) {
        return t * t;
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return {p.delayed[slope_before]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return {p.delayed[slope_before] + R(1)};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.accessory[last] = lane.t;
        lane.accessory[found] += 1;
        lane.accessory[sum_of_lateness] += myriad::abs(lane.t - myriad::floor(lane.t) - 0.5);
    }
};

/// y' = exp(-y) + l (sin y'(a) - sin(1 / (3 + a))) with a = t (1 - cos 2 pi t) / 2, where the delay vanishes again and
/// again: ln(t + 3). Problems F3 to F5 of Enright and Hayashi, DDETST (1997).
struct logarithm {
    enum state { y, n_state };
    enum parameter { l, n_parameter };
    enum delayed { slope_before, n_delayed };

    MYRIAD_FUNCTION static int delayed_state(int) { return y; }
    MYRIAD_FUNCTION static bool is_delayed_slope(int) { return true; }
    template <class R>
    MYRIAD_FUNCTION static R seen(const R& t) {
        return R(0.5) * t * (R(1) - myriad::cos(R(6.283185307179586) * t));
    }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const R& t, const myriad::vec<R, n_state>&, const auto&) {
        return t - seen(t);
    }
    template <class R>
    MYRIAD_FUNCTION static R history(int, const R& t, const auto&) {
        return myriad::log(t + R(3));
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& now, const auto& p) {
        const R time = R(t);
        return {myriad::exp(-now[y]) +
                p[l] * (myriad::sin(p.delayed[slope_before]) - myriad::sin(R(1) / (R(3) + seen(time))))};
    }
};

}  // namespace neutral
