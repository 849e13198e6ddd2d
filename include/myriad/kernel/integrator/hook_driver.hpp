// SPDX-License-Identifier: MIT
// Calls hooks within a phase: after_step in the accepted lanes, after_event in lanes whose events fired, after_stop in
// those that have reached a stop time, after_trigger where a condition has come to hold; and handles the changes they
// make.
#pragma once

#include "myriad/kernel/controller/stepping.hpp"
#include "myriad/kernel/event/breaking_points.hpp"
#include "myriad/kernel/event/event_driver.hpp"
#include "myriad/kernel/event/stop_driver.hpp"
#include "myriad/kernel/integrator/consistent_state.hpp"
#include "myriad/kernel/integrator/lane_changes.hpp"
#include "myriad/kernel/state/integration_state.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class S>
struct hook_driver {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr auto n = n_state<Model>;
    static constexpr auto m = n_event<Model>;

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S>& s;
    event_driver<Model, Method, S>& events;

    /// Calls after_step on the lanes whose step was accepted.
    MYRIAD_FUNCTION void after_step(const mask& accepted) {
        const lane_data<Model, S> before = kept();
        mask changed = mask(false);
        if constexpr (has_generic_after_step<Model, R>) {
            if constexpr (has_delays<Model>)
                detail::recall<Model>(s.data.t, s.data.y, static_cast<const inputs<Model, S>&>(s.data));
            lane_data<Model, S> after = s.data;
            lane<Model, S> view(after);
            mask stops = mask(false);
            if constexpr (std::is_void_v<decltype(Model::template after_step<S>(view))>) {
                Model::template after_step<S>(view);
            } else {
                stops = accepted & Model::template after_step<S>(view);
            }
            // Compares the hook's input with its output, so that the compiler sees which members it leaves alone.
            changed = accepted & differs(before, after);
            adopt(accepted, before, after);
            if constexpr (has_delays<Model>) s.data.past.forget_recalled();
            if (MYRIAD_UNLIKELY(any(stops))) s.end_lanes(stops, status::stopped_by_user);
            if constexpr (writes_time_domain<Model>) {
                for_each_lane(accepted & (before.t_end != s.data.t_end), [&](int i) MYRIAD_LAMBDA { retarget(i); });
            }
            if constexpr (has_stops<Model>) for_each_lane(accepted, [&](int i) MYRIAD_LAMBDA { update_stops(i); });
        } else {
            for_each_lane(accepted, [&](int i) MYRIAD_LAMBDA {
                run_hook(i, [](auto& lane) MYRIAD_LAMBDA { return Model::after_step(lane); });
            });
            changed = accepted & differs(before, s.data);
        }
        // The slope at the end of the step may be known already, as the first of the next.
        if constexpr (slope_cache<Model, Method, S>::keeps_start || has_events<Model>) {
            if (any(changed)) {
                check_finite(changed, before.y);
                make_consistent(changed);
                follow_up(changed, before);
            }
        } else {
            check_finite(accepted, before.y);
            if constexpr (n_algebraic < Model >> 0) make_consistent(changed);
        }
    }

    /// Handles lanes in which an observer has changed an accessory that rhs or events may read.
    MYRIAD_FUNCTION void follow_observers(const mask& changed) {
        if (any(changed)) follow_up(changed, s.data);
    }

    /// Counts the events that fired and calls after_event for them, in order of their index.
    MYRIAD_FUNCTION void act_on_events() {
        const mask acting = events.fired_lanes();
        if (!MYRIAD_UNLIKELY(any(acting))) return;
        if constexpr (has_after_event<Model>) {
            const lane_data<Model, S> before = kept();
            for_each_lane(acting, [&](int i) MYRIAD_LAMBDA { act_on_lane(i); });
            const mask changed = acting & differs(before, s.data);
            if (any(changed)) {
                s.slopes.invalidate(changed);
                check_finite(changed, before.y);
                make_consistent(changed);
                jump(changed, 0);
                events.update_after_hook(changed);
            }
            for_each_lane(acting, [&](int i) MYRIAD_LAMBDA { events.update_after_events(i, before); });
        } else {
            for_each_lane(acting, [&](int i) MYRIAD_LAMBDA {
                act_on_lane(i);
                events.update_after_events(i, s.data);
            });
        }
    }

    /// Calls after_trigger for the conditions that count as false before the start, in lanes whose phase begins.
    MYRIAD_FUNCTION void begin_triggers(const mask& begun) {
        for_each_lane(begun, [&](int i) MYRIAD_LAMBDA {
            events.conditions().begin(i);
            act_on_triggers_of(i);
        });
        act_on_conditions();
    }
    /// Calls the actions of stop times and triggers at this instant, and those that follow from them.
    MYRIAD_FUNCTION void act_on_conditions() {
        for (std::int32_t rounds = 0;; ++rounds) {
            if constexpr (has_stops<Model>) act_on_stops();
            const mask turned = events.conditions().turned();
            if (!MYRIAD_UNLIKELY(any(turned))) return;
            mask goes_on = mask(false);
            for_each_lane(turned, [&](int i) MYRIAD_LAMBDA {
                events.conditions().update(i);
                const bool acted = act_on_triggers_of(i);
                set_lane(goes_on, i, acted || events.conditions().settle(i));
            });
            if (!any(goes_on)) return;
            if (rounds >= detail::most_actions(args)) return s.end_lanes(goes_on, status::event_accumulation);
        }
    }

    /// Calls after_stop in the lanes that have reached a stop time, after the events there.
    MYRIAD_FUNCTION void act_on_stops() {
        const stop_driver<Model, Method, S> stops{args, s};
        const mask due = stops.due();
        if (!MYRIAD_UNLIKELY(any(due))) return;
        // What the right-hand side does from a stop on need not be what it did before.
        mask acted = mask(false);
        if constexpr (has_triggers<Model>) {
            for_each_lane(due, [&](int i) MYRIAD_LAMBDA {
                s.end_lane(i, stops.act(i, [&](auto j, std::int32_t number) MYRIAD_LAMBDA {
                    act_on_stop(i, j, number);
                    if constexpr (has_delays<Model>) set_lane(acted, i, true);
                }));
                lay_steps(i);
            });
            jump(acted, 1);
            return;
        }
        const lane_data<Model, S> before = kept();
        for_each_lane(due, [&](int i) MYRIAD_LAMBDA {
            const status ending = stops.act(i, [&](auto j, std::int32_t number) MYRIAD_LAMBDA {
                if constexpr (has_after_stop<Model>)
                    run_hook(i, [&](auto& lane) MYRIAD_LAMBDA { return Model::after_stop(j, number, lane); });
                if constexpr (has_delays<Model>) set_lane(acted, i, true);
            });
            s.end_lane(i, ending);
            lay_steps(i);
        });
        const mask changed = due & differs(before, s.data);
        jump(acted & !changed, 1);
        follow_action(changed, before);
    }

    /// Lets the jumps of the past arrive that are due, after all actions at this instant: the slope is another from
    /// here on, and so may event functions be that read the past.
    MYRIAD_FUNCTION void arrive(const mask& accepted) {
        const breaking_points<Model, Method, S> breaks{args, s};
        const mask due = breaks.due(accepted);
        if (!MYRIAD_UNLIKELY(any(due))) return;
        [[maybe_unused]] vec<S, m> before;
        if constexpr (has_events<Model>) before = detail::evaluate_events<Model>(s.now(), s.data.y, s.data);
        mask arrived = mask(false), jumped = mask(false);
        for_each_lane(due, [&](int i) MYRIAD_LAMBDA {
            const int level = breaks.arrive(i);
            if (level == no_jump) return;
            set_lane(arrived, i, true);
            set_lane(jumped, i, level <= 1);  // else functions of delayed values go on, and may cross zero here
            stop_driver<Model, Method, S>{args, s}.update(i);
            lay_steps(i);
        });
        s.slopes.invalidate(arrived);
        if constexpr (has_events<Model>) {
            const vec<S, m> after = detail::evaluate_events<Model>(s.now(), s.data.y, s.data);
            const mask moved = jumped & detail::differing<S>(after, before);
            if (!any(moved)) return;
            events.forget_fired();  // their actions are done
            events.update_after_hook(moved, before);
            if constexpr (has_triggers<Model>) {
                for_each_lane(moved, [&](int i) MYRIAD_LAMBDA {
                    events.conditions().update(i);
                    act_on_triggers_of(i);
                });
                act_on_conditions();
            }
        }
    }

private:
    /// The solution jumps in these lanes, or, at `level` 1, its slope: the past has a jump that arrives later.
    MYRIAD_FUNCTION void jump([[maybe_unused]] const mask& lanes, [[maybe_unused]] int level) {
        if constexpr (has_delays<Model>) {
            s.slopes.invalidate(lanes);
            for_each_lane(lanes, [&](int i) MYRIAD_LAMBDA {
                breaking_points<Model, Method, S>{args, s}.jump(i, level);
                if (stop_driver<Model, Method, S>{args, s}.update(i)) lay_steps(i);
            });
        }
    }

    /// The data before a hook is called.
    MYRIAD_FUNCTION lane_data<Model, S> kept() const {
        lane_data<Model, S> before = s.data;
        if constexpr (team_size < Model >> 1) as_part<Model>::template keep_inputs<R>(before);
        return before;
    }
    /// Calls after_trigger for the pending triggers of lane i, in order of their index, and for those that their
    /// actions bring about. Returns whether there were any. Called at several places.
    MYRIAD_LARGE_FUNCTION bool act_on_triggers_of(int i) {
        constexpr auto triggers = n_trigger<Model>;
        auto& pending = events.pending_triggers(i);
        bool acted = false;
        [[maybe_unused]] int last = -1;  // the function whose crossing the last action was at
        for (std::int32_t actions = 0; pending.any_of(); ++actions) {
            if (actions >= detail::most_actions(args)) {
                s.end_lane(i, status::event_accumulation);
                pending.clear();
                break;
            }
            int next = MYRIAD_LENGTH(triggers) - 1;
            for (int j = next - 1; j >= 0; --j) next = pending[j] ? j : next;
            pending.set(next, false);
            act_and_look(i, [&](auto& lane) MYRIAD_LAMBDA {
                if constexpr (triggers_know_their_function<Model>) {
                    const int function = events.function_of(next, i);
                    const bool crossed_again = function == last;
                    last = function;
                    return Model::after_trigger_by(crossed_again ? -1 : function, next, lane);
                } else {
                    return Model::after_trigger(next, lane);
                }
            });
            acted = true;
        }
        return acted;
    }
    /// Calls after_stop for a stop of lane i in a model with triggers: what its action brings about comes before the
    /// next stop.
    MYRIAD_FUNCTION void act_on_stop(int i, int stop, std::int32_t number) {
        if constexpr (has_after_stop<Model>) {
            act_and_look(i, [&](auto& lane) MYRIAD_LAMBDA { return Model::after_stop(stop, number, lane); });
            act_on_triggers_of(i);
        }
    }
    /// Calls the action of a stop or a trigger of lane i, and looks at its conditions again.
    template <class Hook>
    MYRIAD_FUNCTION void act_and_look(int i, const Hook& hook) {
        const lane_data<Model, S> before = s.data;
        run_hook(i, hook);
        mask one = mask(false);
        set_lane(one, i, true);
        follow_action(one & differs(before, s.data), before);
        events.conditions().update(i);
    }
    /// After the action of a stop or a trigger has changed these lanes; `before`: as they were.
    MYRIAD_FUNCTION void follow_action(const mask& changed, const lane_data<Model, S>& before) {
        if (!any(changed)) return;
        check_finite(changed, before.y);
        make_consistent(changed);
        jump(changed, 0);
        if constexpr (has_events<Model>) events.forget_fired();  // their actions are done
        follow_up(changed, before);
    }

    MYRIAD_FUNCTION void act_on_lane(int i) {
        const auto act = [&](auto j) MYRIAD_LAMBDA {
            if (!events.has_fired(j, i)) return;
            const auto detections = static_cast<std::int32_t>(get_lane(s.data.event_count[j], i)) + 1;
            set_lane(s.data.event_count[j], i, detections);
            if constexpr (has_after_event<Model>) {
                run_hook(i, [&](auto& lane) MYRIAD_LAMBDA { return Model::after_event(j, lane); });
            }
            if (args.event[j].stop_after > 0 && detections >= args.event[j].stop_after)
                s.end_lane(i, status::stopped_by_event);
            if (events.count_action(j, i) >= args.accumulation_limit) s.end_lane(i, status::event_accumulation);
        };
        if constexpr (m <= MYRIAD_MOST_COPIES) {
            static_for<0, m>(act);
        } else {  // copies of so many actions would take minutes to compile
            for (int j = 0; j < MYRIAD_LENGTH(m); ++j) act(j);
        }
    }

    /// Calls a scalar hook and carries out the action that it returns.
    template <class Hook>
    MYRIAD_FUNCTION void run_hook(int i, Hook&& hook) {
        const R t_end = get_lane(s.data.t_end, i), h_next = get_lane(s.data.h_next, i);
        const action wanted = detail::run_on_lane(s.data, i, [&](auto& lane) MYRIAD_LAMBDA {
            if constexpr (keeps_end_of_phase<Model>) {
                const bool is_over = get_lane(s.ended, i) && s.ending[i] != status::success;
                if (is_over) return Model::after_end(lane, hook);
            }
            return detail::action_of([&]() MYRIAD_LAMBDA { return hook(lane); });
        });
        if (get_lane(s.data.h_next, i) != h_next) s.end_lane(i, s.take_step_size(args, i, h_next));
        if constexpr (writes_time_domain<Model>) {
            if (get_lane(s.data.t_end, i) != t_end) retarget(i);
        }
        if constexpr (has_stops<Model>) update_stops(i);
        s.carry_out(i, wanted);
    }

    /// A hook moved the end of the phase: the phase continues to it, backwards if need be, or ends if it is there.
    MYRIAD_FUNCTION void retarget(int i) {
        const R t = get_lane(s.data.t, i);
        const R t_end = get_lane(s.data.t_end, i);
        if (t_end != t_end) return s.end_lane(i, status::not_finite);
        if constexpr (has_delays<Model>)
            if (t_end < t) return s.end_lane(i, status::invalid_delay);  // the past is kept forwards
        const bool there = t == t_end;
        if (s.ending[i] == status::success) set_lane(s.ended, i, there);  // other endings stand
        if constexpr (has_known_stops<Model>) stop_driver<Model, Method, S>{args, s}.update(i);
        if (there) return;
        stepping<Model, Method, S>{args, s}.move(i, t);
    }

    /// A hook may have moved the stop times of lane i.
    MYRIAD_FUNCTION void update_stops(int i) {
        if (stop_driver<Model, Method, S>{args, s}.update(i)) lay_steps(i);
    }
    /// The steps of lane i end elsewhere than before.
    MYRIAD_FUNCTION void lay_steps(int i) {
        const R t = get_lane(s.data.t, i);
        if (t != get_lane(s.data.t_end, i)) stepping<Model, Method, S>{args, s}.move(i, t);
    }

    /// Adopts the changes that a generic hook made to `before`, in the given lanes.
    MYRIAD_FUNCTION void adopt(const mask& lanes, const lane_data<Model, S>& before, const lane_data<Model, S>& after) {
        const auto take = [&](auto use, auto& to, const auto& from, const auto& old) MYRIAD_LAMBDA {
            if constexpr (use.written) to = detail::chosen(lanes, from, old);
        };
        detail::for_each_member<Model>(take, s.data, after, before);
        const mask rescaled = lanes & differs_in_bits(after.h_next, before.h_next);
        if (any(rescaled)) {
            for_each_lane(rescaled, [&](int i) MYRIAD_LAMBDA {
                s.end_lane(i, s.take_step_size(args, i, get_lane(before.h_next, i)));
            });
        }
    }

    /// Lanes in which an input of rhs or events has changed.
    MYRIAD_FUNCTION mask differs(const lane_data<Model, S>& a, const lane_data<Model, S>& b) const {
        mask different = mask(false);
        const auto compare = [&](auto use, const auto& x, const auto& y) MYRIAD_LAMBDA {
            if constexpr (use.acts) different = different | detail::differing<S>(x, y);
        };
        detail::for_each_member<Model>(compare, a, b);
        if constexpr (team_size < Model >> 1) different = different | as_part<Model>::template inputs_differ<R>();
        return team_for<Model>::any(different);
    }

    /// After a hook changed lanes that were as in `before`: slopes and event functions are evaluated again.
    MYRIAD_FUNCTION void follow_up(const mask& changed, const lane_data<Model, S>& before) {
        s.slopes.invalidate(changed);
        if constexpr (has_delays<Model>) {
            for_each_lane(changed, [&](int i) MYRIAD_LAMBDA { s.data.past.lane[i].resumes = true; });
            s.data.past.forget_recalled();
        }
        if constexpr (has_events<Model>) {
            const inputs<Model, S>& p = before;
            events.update_after_hook(changed, detail::evaluate_events<Model>(s.now(), before.y, p));
        }
    }

    /// Algebraic states follow what a hook has changed in these lanes.
    MYRIAD_FUNCTION void make_consistent([[maybe_unused]] const mask& changed) {
        if constexpr (n_algebraic < Model >> 0) {
            for_each_lane(changed & !s.ended, [&](int i) MYRIAD_LAMBDA {
                s.end_lane(i, detail::make_state_consistent(args, s, i).ending);
            });
        }
    }

    /// Refuses a state that is not finite: restores `before` and ends the lane.
    MYRIAD_FUNCTION void check_finite(const mask& lanes, const vec<S, n>& before) {
        const mask bad = lanes & !team_for<Model>::all(all_finite(s.data.y));
        if (MYRIAD_UNLIKELY(any(bad))) {
            MYRIAD_UNROLL
            for (int c = 0; c < MYRIAD_LENGTH(n); ++c) s.data.y[c] = select(bad, before[c], s.data.y[c]);
            s.end_lanes(bad, status::not_finite);
        }
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
