// SPDX-License-Identifier: MIT
// Models with delays, most of which have a closed solution.
#pragma once

#include <cmath>

#include <myriad/model.hpp>

namespace delays {

/// y' = -y(t - tau), y = 1 before: between multiples of tau a polynomial.
struct decay {
    enum state { y, n_state };
    enum parameter { tau, n_parameter };
    enum delayed { past, n_delayed };
    enum integer_accessory { steps, n_integer_accessory };

    MYRIAD_FUNCTION static int delayed_state(int) { return y; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const auto& p) {
        return p[tau];
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return {-p.delayed[past]};
    }
};

/// y' = y(t - 1 / r), y = 1 before: 1 + t where r is zero, as the delay is infinite there.
struct rare {
    enum state { y, n_state };
    enum parameter { r, n_parameter };
    enum delayed { past, n_delayed };

    MYRIAD_FUNCTION static int delayed_state(int) { return y; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const auto& p) {
        return R(1) / p[r];
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return {p.delayed[past]};
    }
};

/// y' = y(min(t - 1/2, 1/4)), y = 1 before: from t = 3/4 on y = 57/32 + 5/4 (t - 3/4).
struct frozen {
    enum state { y, n_state };
    enum delayed { past, n_delayed };

    MYRIAD_FUNCTION static int delayed_state(int) { return y; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const R& t, const myriad::vec<R, n_state>&, const auto&) {
        return myriad::select(t > R(0.75), t - R(0.25), R(0.5));
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return {p.delayed[past]};
    }
};

/// Three states, two of which are delayed, by three delays: y1' = y1(t - 1), y2' = y1(t - 1) + y2(t - 0.2), y3' =
/// y2(t). Example 3 of Wille and Baker, J. Comput. Appl. Math. 43 (1992) 301-305.
struct chain {
    enum state { y1, y2, y3, n_state };
    enum delayed { y1_before, y2_before, n_delayed };

    MYRIAD_FUNCTION static int delayed_state(int j) { return j == y1_before ? y1 : y2; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int j, const auto&) {
        return j == y1_before ? R(1) : R(0.2);
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {p.delayed[y1_before], p.delayed[y1_before] + p.delayed[y2_before], y[y2]};
    }
};

/// y' = y y(ln y) / t, y = 1 before t = 1: t up to e, exp(t / e) up to e^2, (e / (3 - ln t))^e up to t = e^3 / e^(..).
/// Neves, ACM Trans. Math. Software 1 (1975) 357-368, in Paul's test set (1994) problem 2.1.
struct logarithm {
    enum state { y, n_state };
    enum delayed { past, n_delayed };

    MYRIAD_FUNCTION static int delayed_state(int) { return y; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const R& t, const myriad::vec<R, n_state>& now, const auto&) {
        using std::log;
        return t - log(now[y]);
    }
    template <class R>
    MYRIAD_FUNCTION static R history(int, const R&, const auto&) {
        return R(1);
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& now, const auto& p) {
        return {now[y] * p.delayed[past] / t};
    }
};

/// y' = -y + q (y(q t) - exp(-q t)) / 2, y(0) = 1: exp(-t). The delay vanishes at t = 0, for q = 1 everywhere.
struct pantograph {
    enum state { y, n_state };
    enum parameter { q, n_parameter };
    enum delayed { past, n_delayed };

    MYRIAD_FUNCTION static int delayed_state(int) { return y; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const R& t, const myriad::vec<R, n_state>&, const auto& p) {
        return t * (R(1) - p[q]);
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& now, const auto& p) {
        using std::exp;
        return {-now[y] + R(0.5) * p[q] * (p.delayed[past] - exp(-p[q] * t))};
    }
};

/// The same, with an event where the delayed value is one half, and what it was at the beginning.
struct watched_pantograph : pantograph {
    enum accessory { at_begin, seen, n_accessory };
    enum event { half, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return {p.delayed[past] - R(0.5)};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) { lane.accessory[at_begin] = lane.delayed[past]; }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) { lane.accessory[seen] = lane.t; }
};

/// y' = a y(t - tau) + b y, y = exp(m t) before and after, if m = a exp(-m tau) + b. Stiff for a large -b.
struct exponential {
    enum state { y, n_state };
    enum parameter { tau, a, b, m, n_parameter };
    enum delayed { past, n_delayed };

    MYRIAD_FUNCTION static int delayed_state(int) { return y; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const auto& p) {
        return p[tau];
    }
    template <class R>
    MYRIAD_FUNCTION static R history(int, const R& t, const auto& p) {
        using std::exp;
        return exp(p[m] * t);
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& now, const auto& p) {
        return {p[a] * p.delayed[past] + p[b] * now[y]};
    }
};

/// A clock x' = 1, which events and stops set back, and what was seen of it: z' = x(t - tau). The event is that the
/// clock was at 1 a while ago, and the action keeps what it was then.
struct echo {
    enum state { x, z, n_state };
    enum parameter { tau, period, n_parameter };
    enum accessory { seen, time, n_accessory };
    enum event { heard, n_event };
    enum stop { reset, n_stop };
    enum delayed { x_before, n_delayed };

    MYRIAD_FUNCTION static int delayed_state(int) { return x; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const auto& p) {
        return p[tau];
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return {R(1), p.delayed[x_before]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return {p.delayed[x_before] - R(1)};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.accessory[seen] = lane.delayed[x_before];
        lane.accessory[time] = lane.t;
    }
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, int number, const auto& p) {
        return p[period] * static_cast<R>(number + 1);
    }
    MYRIAD_FUNCTION static void after_stop(int, int, auto& lane) { lane.y[x] = 0; }
};

/// A clock that a trigger sets back whenever it has come to 0.01, and that counts how often; with a value of the past,
/// whose jumps arrive when the trigger acts, or between.
struct recurrent {
    enum state { clock, n_state };
    enum parameter { tau, n_parameter };
    enum integer_accessory { count, n_integer_accessory };
    enum event { crossing, n_event };
    enum trigger { full, n_trigger };
    enum delayed { before, n_delayed };

    MYRIAD_FUNCTION static int delayed_state(int) { return clock; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const auto& p) {
        return p[tau];
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return myriad::vec<R, n_state>{R(1) + R(0) * p.delayed[before]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[clock] - R(0.01)};
    }
    MYRIAD_FUNCTION static bool condition(int, const auto& positive) { return positive[crossing]; }
    MYRIAD_FUNCTION static void after_trigger(int, auto& lane) {
        lane.y[clock] = 0;
        lane.integer_accessory[count] += 1;
    }
};

}  // namespace delays
