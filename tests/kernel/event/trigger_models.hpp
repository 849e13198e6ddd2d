// SPDX-License-Identifier: MIT
// Models with triggers, conditions of several event functions.
#pragma once

#include <type_traits>

#include <myriad/action_queue.hpp>
#include <myriad/model.hpp>

namespace triggers {

/// x' = 1 from 0 and event functions of time, cos t and t - c. The times of the actions and which they were: code = 10
/// * code + trigger + 1.
struct logic {
    enum state { x, n_state };
    enum parameter { c, n_parameter };
    static constexpr int log_length = 8;
    enum accessory { n_accessory = log_length };
    enum integer_accessory { code, actions, n_integer_accessory };
    enum event { wave, late, n_event };
    enum trigger { both, either, neither, at_start, n_trigger };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto&) {
        return myriad::vec<R, n_state>{R(1)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto t, const myriad::vec<R, n_state>&, const auto& p) {
        return {myriad::cos(t), t - p[c]};
    }
    MYRIAD_FUNCTION static bool condition(int trigger, const auto& positive) {
        switch (trigger) {
            case both:
                return positive[wave] && positive[late];
            case either:
                return positive[wave] || positive[late];
            case neither:
                return !positive[wave] && !positive[late];
            default:
                return positive[wave];
        }
    }
    MYRIAD_FUNCTION static bool initial_value(int trigger) { return trigger != at_start; }
    MYRIAD_FUNCTION static void after_trigger(int trigger, auto& lane) {
        const int n = lane.integer_accessory[actions];
        if (n < log_length) lane.accessory[n] = lane.t;
        lane.integer_accessory[actions] = n + 1;
        lane.integer_accessory[code] = 10 * lane.integer_accessory[code] + trigger + 1;
    }
};

/// x' = 1 from 0, and y' = 0. Where x rises through 1 three conditions come to hold at once; the first action moves y
/// so that the second and third do not hold any more, and the second of them is not persistent; and a fourth does.
struct chain {
    enum state { x, y, n_state };
    enum integer_accessory { code, n_integer_accessory };
    enum accessory { time, n_accessory };
    enum event { reached, high, n_event };
    enum trigger { moves, persists, lapses, follows, n_trigger };
    enum shared_integer { end_at, n_shared_integer };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto&) {
        return {R(1), R(0)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return {s[x] - R(1), s[y] - R(0.5)};
    }
    MYRIAD_FUNCTION static bool condition(int trigger, const auto& positive) {
        if (trigger == moves) return positive[reached];
        return trigger == follows ? positive[high] : positive[reached] && !positive[high];
    }
    MYRIAD_FUNCTION static bool persistent(int trigger) { return trigger != lapses; }
    MYRIAD_FUNCTION static myriad::action after_trigger(int trigger, auto& lane) {
        lane.integer_accessory[code] = 10 * lane.integer_accessory[code] + trigger + 1;
        lane.accessory[time] = lane.t;
        if (trigger == moves) lane.y[y] = 1;
        return lane.integer_accessory[code] == lane.shared_integer[end_at] ? myriad::action::end_phase
                                                                           : myriad::action::proceed;
    }
};

/// x' = -1 while a heater is off and 1 while it is on; it is switched off above 1 and on below 0, but only while a
/// clock's phase allows: a thermostat with a timer.
struct thermostat {
    enum state { x, n_state };
    enum integer_accessory { on, switched, n_integer_accessory };
    enum parameter { from, n_parameter };
    enum event { warm, cold, allowed, n_event };
    enum trigger { off_now, on_now, n_trigger };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return myriad::vec<R, n_state>{myriad::select(p.integer_accessory[on] != 0, R(1), R(-1))};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[x] - R(1), -y[x], t - p[from]};
    }
    MYRIAD_FUNCTION static bool condition(int trigger, const auto& positive) {
        return trigger == off_now ? positive[warm] : positive[cold] && positive[allowed];
    }
    MYRIAD_FUNCTION static void after_trigger(int trigger, auto& lane) {
        lane.integer_accessory[on] = trigger == on_now ? 1 : 0;
        lane.integer_accessory[switched] += 1;
    }
};

/// x' = 1; `delay` after x has risen through 1 a stop takes it down by 2.
struct relay {
    enum state { x, n_state };
    enum parameter { delay, n_parameter };
    enum accessory { due, n_accessory };
    enum integer_accessory { actions, n_integer_accessory };
    enum event { one, n_event };
    enum trigger { reached, n_trigger };
    enum stop { falls, n_stop };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto&) {
        return myriad::vec<R, n_state>{R(1)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[x] - R(1)};
    }
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, int, const auto& p) {
        return p.accessory[due];  // NaN, no stop, until something is due
    }
    MYRIAD_FUNCTION static bool condition(int, const auto& positive) { return positive[one]; }
    MYRIAD_FUNCTION static bool initial_value(int) { return false; }
    MYRIAD_FUNCTION static void after_trigger(int, auto& lane) { lane.accessory[due] = lane.t + lane.parameter[delay]; }
    MYRIAD_FUNCTION static void after_stop(int, int, auto& lane) {
        using R = std::remove_cvref_t<decltype(lane.t)>;
        lane.y[x] -= R(2);
        lane.accessory[due] = myriad::nan_of<R>;
        lane.integer_accessory[actions] += 1;
    }
};

/// x' = 1 from 0. Where x reaches 1 two actions are put for t = 2, `low` and `high`. The latter moves y, and where y is
/// high an action is put that runs at once, of a priority between them. code = 10 * code + action + 1.
struct cascade {
    enum action { low, between, high, n_actions };
    using queue = myriad::action_queue<0, 1, n_actions>;
    enum state { x, y, n_state };
    enum accessory { n_accessory = queue::n_accessory };
    enum integer_accessory { code, n_integer_accessory = 1 + queue::n_integer_accessory };
    enum event { reached, moved, n_event };
    enum trigger { begins, follows, n_trigger };
    enum stop { due, n_stop };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto&) {
        return {R(1), R(0)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return {s[x] - R(1), s[y] - R(0.5)};
    }
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, int, const auto& p) {
        return queue::next_time(p);
    }
    MYRIAD_FUNCTION static bool condition(int trigger, const auto& positive) { return positive[trigger]; }
    MYRIAD_FUNCTION static myriad::action after_trigger(int trigger, auto& lane) {
        using R = std::remove_cvref_t<decltype(lane.t)>;
        const bool fits = trigger == follows ? queue::put(lane, between, lane.t)
                                             : queue::put(lane, low, R(2)) && queue::put(lane, high, R(2));
        return fits ? myriad::action::proceed : myriad::action::overflow;
    }
    MYRIAD_FUNCTION static void after_stop(int, int, auto& lane) {
        const int taken = queue::take(lane, [](int action) MYRIAD_LAMBDA { return action; }).action;
        lane.integer_accessory[code] = 10 * lane.integer_accessory[code] + taken + 1;
        if (taken == high) lane.y[y] = 1;
    }
};

/// x' = rate, and at the time c an action sets x to 1. The times at which x >= 1 and x > 1 came to hold, and how often.
struct edges {
    enum state { x, n_state };
    enum parameter { rate, c, n_parameter };
    enum accessory { t_reached, t_passed, n_accessory };
    enum integer_accessory { times_reached, times_passed, n_integer_accessory };
    enum event { beyond, short_of, clock, n_event };
    enum trigger { sets, reaches, passes, n_trigger };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return myriad::vec<R, n_state>{R(p[rate])};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[x] - R(1), R(1) - y[x], R(t - p[c])};
    }
    MYRIAD_FUNCTION static bool condition(int trigger, const auto& positive) {
        if (trigger == sets) return positive[clock];
        return trigger == reaches ? positive[beyond] : !positive[short_of];
    }
    MYRIAD_FUNCTION static void after_trigger(int trigger, auto& lane) {
        if (trigger == sets) {
            lane.y[x] = 1;
        } else if (trigger == reaches) {
            lane.accessory[t_reached] = lane.t;
            lane.integer_accessory[times_reached] += 1;
        } else {
            lane.accessory[t_passed] = lane.t;
            lane.integer_accessory[times_passed] += 1;
        }
    }
};

/// x falls from zero and y rises to one half: the action that follows x's side moves y, whose event is located
/// meanwhile.
struct falling {
    enum state { x, y, n_state };
    enum accessory { t_action, t_event, y_event, n_accessory };
    enum integer_accessory { actions, detections, n_integer_accessory };
    enum event { zero, half, n_event };
    enum trigger { below, n_trigger };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto&) {
        return {R(-1), R(1)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return {s[x], s[y] - R(0.5)};
    }
    MYRIAD_FUNCTION static bool condition(int, const auto& positive) { return !positive[zero]; }
    MYRIAD_FUNCTION static void after_trigger(int, auto& lane) {
        lane.y[y] -= 10;
        lane.accessory[t_action] = lane.t;
        lane.integer_accessory[actions] += 1;
    }
    MYRIAD_FUNCTION static void after_event(int j, auto& lane) {
        if (j != half) return;
        lane.accessory[t_event] = lane.t;
        lane.accessory[y_event] = lane.y[y];
        lane.integer_accessory[detections] += 1;
    }
};

/// The same one instance at a time, as in a GPU's thread.
template <class Model>
struct alone : Model {
    static constexpr bool scalar_only = true;
};

}  // namespace triggers
