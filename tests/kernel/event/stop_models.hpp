// SPDX-License-Identifier: MIT
// Models with stop times: doses, infusions with a beginning and an end, stops that other actions set, and events at the
// times of stops.
#pragma once

#include <type_traits>

#include <myriad/model.hpp>

namespace stops {

/// A drug that is absorbed and eliminated, gut' = -ka gut and blood' = ka gut - ke blood. Doses go into the gut. It
/// keeps the times and numbers of the first actions.
struct dosed {
    enum state { gut, blood, n_state };
    enum parameter { ka, ke, amount, first, interval, doses, n_parameter };
    static constexpr int log_length = 6;
    enum accessory { n_accessory = log_length };
    enum integer_accessory { given, last_number, n_integer_accessory };
    enum stop { dose, n_stop };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {-p[ka] * y[gut], p[ka] * y[gut] - p[ke] * y[blood]};
    }
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, int number, const auto& p) {
        return myriad::recurring(number, p[first], p[interval], p[doses]);
    }
    MYRIAD_FUNCTION static void after_stop(int, int number, auto& lane) {
        const int n = lane.integer_accessory[given];
        if (n < log_length) lane.accessory[n] = lane.t;
        lane.integer_accessory[given] = n + 1;
        lane.integer_accessory[last_number] = number;
        lane.y[gut] += lane.parameter[amount];
    }
};
/// x' = 1 with stops at times given one by one, and what happened: code = 10 * code + kind + 1 for each action. At a
/// given code an action ends the phase, or the instance.
struct listed {
    enum state { x, n_state };
    enum parameter { t0, t1, t2, t3, late, n_parameter };
    enum integer_accessory { code, n_integer_accessory };
    enum accessory { last_time, n_accessory };
    enum stop { of_list, late_one, n_stop };
    enum shared_integer { end_at, end_how, n_shared_integer };
    static constexpr int no_number = 1000000, minus = 1000001;  // parameters that stand for NaN and minus infinity

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto&) {
        return myriad::vec<R, n_state>{R(1)};
    }
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int stop, int number, const auto& p) {
        if (number > (stop == of_list ? 3 : 0)) return myriad::infinity_of<R>;
        const R time = stop == late_one ? p[late] : p.parameter[number];
        return time == R(no_number) ? myriad::nan_of<R> : time == R(minus) ? -myriad::infinity_of<R> : time;
    }
    MYRIAD_FUNCTION static myriad::action after_stop(int stop, int, auto& lane) {
        lane.integer_accessory[code] = 10 * lane.integer_accessory[code] + stop + 1;
        lane.accessory[last_time] = lane.t;
        if (lane.integer_accessory[code] != lane.shared_integer[end_at]) return myriad::action::proceed;
        return lane.shared_integer[end_how] == 1 ? myriad::action::end_phase : myriad::action::end_instance;
    }
};

/// An infusion, y' = rate - y, whose rate jumps at its beginning and at its end.
struct infused {
    static constexpr bool writes_parameters = true;
    enum state { y, n_state };
    enum parameter { rate, start, finish, n_parameter };
    enum stop { begin, end, n_stop };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return myriad::vec<R, n_state>{p[rate] - s[y]};
    }
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int stop, int number, const auto& p) {
        return number > 0 ? myriad::infinity_of<R> : stop == begin ? p[start] : p[finish];
    }
    MYRIAD_FUNCTION static void after_stop(int stop, int, auto& lane) { lane.parameter[rate] = stop == begin ? 1 : 0; }
};

/// x' = 1 with an event at x = level, after which an action follows `delay` later: it takes x down by `fall`. The time
/// of the action is a component of its own, infinite at first, which the event sets and the action leaves as it is.
struct delayed {
    enum state { x, n_state };
    enum parameter { level, delay, fall, n_parameter };
    enum accessory { due, t_event, t_action, n_accessory };
    enum integer_accessory { events_seen, actions, n_integer_accessory };
    enum event { reached, n_event };
    enum stop { action, n_stop };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto&) {
        return myriad::vec<R, n_state>{R(1)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_event>{y[x] - p[level]};
    }
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, int number, const auto& p) {
        return number == 0 ? p.accessory[due] : myriad::infinity_of<R>;
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        if (lane.phase == 0) lane.accessory[due] = myriad::infinity_of<std::remove_cvref_t<decltype(lane.t)>>;
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.integer_accessory[events_seen] += 1;
        lane.accessory[t_event] = lane.t;
        lane.accessory[due] = lane.t + lane.parameter[delay];
    }
    MYRIAD_FUNCTION static void after_stop(int, int, auto& lane) {
        lane.integer_accessory[actions] += 1;
        lane.accessory[t_action] = lane.t;
        lane.y[x] -= lane.parameter[fall];
    }
};

/// x' = 1 and an event at x = level; a stop at `time` adds `kick` to x. What happened: code = 10 * code + 1 for the
/// event, + 2 for the stop.
struct kicked {
    enum state { x, n_state };
    enum parameter { level, time, kick, n_parameter };
    enum integer_accessory { code, n_integer_accessory };
    enum event { reached, n_event };
    enum stop { kicks, n_stop };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto&) {
        return myriad::vec<R, n_state>{R(1)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_event>{y[x] - p[level]};
    }
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, int number, const auto& p) {
        return number == 0 ? p[time] : myriad::infinity_of<R>;
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.integer_accessory[code] = 10 * lane.integer_accessory[code] + 1;
    }
    MYRIAD_FUNCTION static void after_stop(int, int, auto& lane) {
        lane.integer_accessory[code] = 10 * lane.integer_accessory[code] + 2;
        lane.y[x] += lane.parameter[kick];
    }
};

/// x' = -x, doubled at t = 1, where the action also moves the end of the phase.
struct prolonged {
    static constexpr bool writes_time_domain = true;
    enum state { x, n_state };
    enum parameter { time, new_end, n_parameter };
    enum stop { doubling, n_stop };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, int number, const auto& p) {
        return number == 0 ? p[time] : myriad::infinity_of<R>;
    }
    MYRIAD_FUNCTION static void after_stop(int, int, auto& lane) {
        lane.y[x] *= 2;
        lane.t_end = lane.parameter[new_end];
    }
};

/// x' = -x^2 and, at a stop, x^2: for tangents.
struct squared {
    enum state { x, n_state };
    enum parameter { time, n_parameter };
    enum stop { squaring, n_stop };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x] * y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, int number, const auto& p) {
        return number == 0 ? p[time] : myriad::infinity_of<R>;
    }
    MYRIAD_FUNCTION static void after_stop(int, int, auto& lane) { lane.y[x] = lane.y[x] * lane.y[x]; }
};

/// The same one instance at a time, as in a GPU's thread.
template <class Model>
struct alone : Model {
    static constexpr bool scalar_only = true;
};

}  // namespace stops
