// SPDX-License-Identifier: MIT
// The main loop: takes every instance of a source through its phases, step by step, on one pack of lanes. A lane whose
// instance has ended takes the next one, so no lane waits for another. The same body is the CUDA kernel (one lane) and
// the OpenMP backend's inner loop (a pack of lanes).
#pragma once

#include <cstdint>

#include "myriad/kernel/controller/initial_step.hpp"
#include "myriad/kernel/controller/stepping.hpp"
#include "myriad/kernel/event/event_driver.hpp"
#include "myriad/kernel/integrator/free_run.hpp"
#include "myriad/kernel/integrator/hook_driver.hpp"
#include "myriad/kernel/integrator/phase.hpp"
#include "myriad/kernel/integrator/phase_watchdog.hpp"
#include "myriad/kernel/integrator/trial_iteration.hpp"
#include "myriad/kernel/integrator/warp_aggregation.hpp"
#include "myriad/kernel/output/observers.hpp"
#include "myriad/kernel/state/integration_state.hpp"
#include "myriad/kernel/stepper/component_loop.hpp"
#include "myriad/kernel/stepper/stepper.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class S>
struct integrator {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr auto n = n_state<Model>;
    static constexpr auto m = n_event<Model>;
    using watchdog_type = phase_watchdog<Model, Method, S>;
    using trial_type = trial_step<Method, S, n>;
    using stepping_type = stepping<Model, Method, S>;
    using event_driver_type = event_driver<Model, Method, S>;
    using detection_type = typename event_driver_type::detection;
    using observers_type = observers<Model, Method, S>;

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S> s;
    typename observers_type::memories observed;
    event_memories<Model, R, lanes_of<S>>* memory;

    template <class Source>
    MYRIAD_FUNCTION void run(Source& source, const shared_parameters<R>& shared) {
        clear(shared);
        event_driver_type events(args, s, memory);
        events.clear();
        while (!(any(s.ended) || watchdog_type{args, s}.is_due()) || fill_lanes(source, events)) {
            MYRIAD_RECONVERGE;
            if constexpr (has_triggers<Model>) {
                if (any(s.ended)) continue;  // by an action before the first step
            }
            if constexpr (runs_freely<Model, Method, S> && has_delays<Model>) {
                s.end_lane(0, free_run<Model, Method, S>{args, s}.take_steps_with_past(source));
            } else if constexpr (runs_freely<Model, Method, S>) {
                s.end_lane(0, free_run<Model, Method, S>{args, s}.take_steps(source));
            }
            trial_storage<Method, Model, S> storage;
            trial_type& trial = storage.trial();
            propose_step(events);
            take_step(trial);
            detection_type detected;
            if constexpr (has_events<Model>) {
                detected = events.detect(events_at_end(trial));
                if (waits(detected, events)) continue;
            }
            ++s.iteration;
            const step_decision<S> decided = judge(trial, detected, events);
            mask accepted = decided.accepted;
            if constexpr (locates_breaks) accepted = accepted & !locate_breaks(trial, accepted, events);
            // A single lane has no branch here: in every step it would cost more than this addition.
            s.rejected = count_where(s.running() & !accepted, s.rejected);
            if constexpr (has_events<Model>) events.locate(trial, end_time(), detected, accepted);
            mask changed;
            if constexpr (observers_type::any_watches) changed = observe(trial, accepted, events);
            if constexpr (!is_pack<S>) {
                if (!accepted && !events.fired_lanes()) continue;
            }
            commit(trial, accepted, events);
            hook_driver<Model, Method, S> hooks{args, s, events};
            if constexpr (observers_type::change_inputs) hooks.follow_observers(changed);
            if constexpr (has_after_step<Model>) hooks.after_step(accepted);
            if constexpr (has_events<Model>) hooks.act_on_events();
            if constexpr (has_triggers<Model>) {
                hooks.act_on_conditions();
            } else if constexpr (has_stops<Model>) {
                hooks.act_on_stops();
            }
            if constexpr (has_delays<Model>) hooks.arrive(accepted);
        }
        if constexpr (requires { source.gives_only_one(); })
            phase_driver<Model, Method, S>{args, s, events, observed}.finish(0);
    }

    /// An empty pack: every lane needs an instance.
    MYRIAD_FUNCTION void clear(const shared_parameters<R>& shared) {
        s.data.shared = shared.real;
        s.data.shared_integer = shared.integer;
        s.active = mask(false);
        s.ended = mask(true);
        s.clear_iterations(args);
        if constexpr (stochastic_method<Method>) s.steps.clear_path();
        MYRIAD_UNROLL
        for (int i = 0; i < lanes_of<S>; ++i) {
            s.instance[i] = -1;
            if constexpr (has_delays<Model>) breaking_points<Model, Method, S>{args, s}.clear(i);
        }
    }

    /// Moves lanes whose phase has ended to their next phase or instance. Returns false when no lane is running.
    template <class Source>
    MYRIAD_FUNCTION bool fill_lanes(Source& source, event_driver_type& events) {
        watchdog_type watchdog{args, s};
        if (is_pack<S> || !any(s.ended)) {
            for_each_lane(s.running() & !s.ended, [&](int i) MYRIAD_LAMBDA {
                watchdog.check(i, [&](status why) MYRIAD_LAMBDA { s.end_lane(i, why); });
            });
            if (watchdog.gives_up(source)) s.end_lanes(s.running() & !s.ended, status::interrupted);
        }
        if (!any(s.ended)) {
            watchdog.schedule();
            return true;
        }
        mask begun = mask(false);
        for_each_lane(s.ended, [&](int i) MYRIAD_LAMBDA {
            set_lane(begun, i, phase_driver<Model, Method, S>{args, s, events, observed}.advance(i, source));
        });
        s.ended = mask(false);
        if constexpr (has_triggers<Model>) {
            events.begin(begun);
            const vec<S, n> before = s.data.y;
            hook_driver<Model, Method, S>{args, s, events}.begin_triggers(begun);
            if constexpr (sampler<Model, Method, S>::watches) {
                mask acted = mask(false);
                MYRIAD_UNROLL
                for (int c = 0; c < MYRIAD_LENGTH(n); ++c) acted = acted | differs_in_bits(s.data.y[c], before[c]);
                for_each_lane(begun & acted, [&](int i) MYRIAD_LAMBDA {
                    if (get_lane(s.data.phase, i) > 0) return;
                    sampler<Model, Method, S>{args, s, observed}.begin_again(i);
                });
            }
        }
        watchdog.schedule();
        if constexpr (is_adaptive<Method> && !stochastic_method<Method>) {
            const mask open = begun & (s.data.h_next == S(R(0)));
            if (any(open)) detail::choose_first_step(args, s, open);
        }
        s.slopes.begin(begun, s.now(), s.data, s.extra_evaluations);
        if constexpr (has_events<Model> && !has_triggers<Model>) events.begin(begun);
        return any(s.active);
    }

    /// The length of the next trial and the slope at its start.
    MYRIAD_FUNCTION void propose_step(event_driver_type& events) {
        mask bound = events.locating();  // steps that end where they were located to
        if constexpr (has_delays<Model>) {
            bound = bound | s.breaks.redone;
            s.breaks.redone = mask(false);
        }
        stepping_type{args, s}.propose(bound);
        if constexpr (has_delays<Model> && is_adaptive<Method>) stay_in_past(bound);
        s.slopes.prepare(s.now(), s.data, s.extra_evaluations);
    }

    /// Shortens steps a little longer than a delay, so that they need not be iterated.
    MYRIAD_FUNCTION void stay_in_past(const mask& bound) {
        constexpr R a_little = R(4);  // an iteration takes the evaluations of about so many steps
        const S longest = breaking_points<Model, Method, S>{args, s}.longest_step();
        const mask shortened = (s.h > longest) & (s.h <= S(a_little) * longest) & !bound;
        if (!any(shortened)) return;
        s.h = select(shortened, (s.data.t + longest) - s.data.t, s.h);
        s.final_step = s.final_step & !shortened;
    }

    MYRIAD_FUNCTION void take_step(trial_type& trial) {
        if constexpr (has_delays<Model>) detail::forget_trial(s.data);
        detail::copy_components(trial.slope_start(), s.slopes.first_stage(s.now(), s.data));
        if constexpr (stochastic_method<Method>) trial.noise = s.steps.interval(args.noise);
        if constexpr (has_delays<Model> && is_adaptive<Method>) {
            trial_iteration<Model, Method, S> iteration{args, s};
            do {
                detail::take_trial_step<Method, Model>(s.now(), s.h, end_time(), s.data.y, s.data, trial);
            } while (iteration.goes_on(trial, end_time()));
        } else {
            detail::take_trial_step<Method, Model>(s.now(), s.h, end_time(), s.data.y, s.data, trial);
        }
    }

    /// The event functions at the end of the trial. Those that read the past within it see the trial's own interpolant.
    MYRIAD_FUNCTION vec<S, m> events_at_end(const trial_type& trial) {
        if constexpr (has_delays<Model> && is_adaptive<Method>) {
            if (MYRIAD_LENGTH(m) == 0) return {};  // of an interpreted model
            const mask known = detail::past_is_known(s.data);
            const vec<S, m> g = detail::evaluate_events<Model>(end_time(), trial.y, s.data);
            const mask open = s.running() & known & !detail::past_is_known(s.data);
            if (!MYRIAD_UNLIKELY(any(open))) return g;
            trial_iteration<Model, Method, S>{args, s}.show(trial, end_time(), open);
            const vec<S, m> seen = detail::evaluate_events<Model>(end_time(), trial.y, s.data);
            trial_iteration<Model, Method, S>{args, s}.is_within(open);
            return seen;
        } else {
            return detail::evaluate_events<Model>(end_time(), trial.y, s.data);
        }
    }

    /// Whether the trial, in which an event may begin, is to be taken again when more threads of the warp have one.
    MYRIAD_FUNCTION bool waits(const detection_type& detected, event_driver_type& events) {
        if constexpr (is_pack<S> || stochastic_method<Method> ||
                      team_size < Model >> 1) {  // a team has one for all its threads
            return false;
        } else {
            constexpr auto interval = stepping_type::stagnation_interval;
            // The watchdog must not see an iteration twice.
            const bool checked = interval > 0 && s.iteration % (interval > 0 ? interval : 1) == 0;
            return detail::waits_for_warp(events.begins(detected), checked, events.turns_waited());
        }
    }

    /// Accepts or rejects the trial by its error and its finiteness, and sets the next step. Ends lanes that are stuck.
    MYRIAD_FUNCTION step_decision<S> judge(const trial_type& trial, const detection_type& detected,
                                           event_driver_type& events) {
        s.slopes.invalidate_end();
        stepping_type steps{args, s};
        mask defined = mask(true);
        if constexpr (has_events<Model>) defined = events.defined(detected);
        if constexpr (has_delays<Model>) defined = defined & detail::past_is_known(s.data);
        const auto end_stuck = [&](const mask& failed, mask still) MYRIAD_LAMBDA {
            // A flight between events may be shorter than the resolution of t.
            still = still & !events.locating();
            for_each_lane(failed | still, [&](int i) MYRIAD_LAMBDA { s.end_lane(i, failure_of(i, events)); });
            return still;
        };
        const step_decision<S> decided = steps.judge(trial, end_time(), defined, end_stuck);
        if constexpr (is_adaptive<Method>) s.data.h_next = select(s.running(), decided.next, s.data.h_next);
        return decided;
    }

    /// Shows the accepted trials to the observers. Returns the lanes in which these have changed inputs.
    MYRIAD_FUNCTION mask observe(const trial_type& trial, const mask& accepted, const event_driver_type& events) {
        const S t1 = end_time();
        const mask at_event = events.fired_lanes();
        return observers_type{args, s, observed}.see({s, trial, t1, accepted, at_event});
    }

    /// Commits the new state of the accepted lanes.
    MYRIAD_FUNCTION void commit(const trial_type& trial, const mask& accepted, const event_driver_type& events) {
        if constexpr (!is_pack<S>) {
            if (!accepted) return;
        }
        detail::each_component<Method, n>(
            [&](int c) MYRIAD_LAMBDA { s.data.y[c] = select(accepted, trial.y[c], s.data.y[c]); });
        if constexpr (shows_step) s.data.h = select(accepted, s.h, s.data.h);
        s.ended = s.ended | stepping_type{args, s}.advance(accepted, end_time(), events.fired_lanes());
        s.slopes.accept(accepted, trial);
    }

private:
    static constexpr bool locates_breaks = [] {
        if constexpr (has_delays<Model>) {
            return breaking_points<Model, Method, S>::may_locate;
        } else {
            return false;
        }
    }();
    /// The lanes whose step is taken again up to where a jump of the past arrives.
    MYRIAD_FUNCTION mask locate_breaks(const trial_type& trial, const mask& accepted, const event_driver_type& events) {
        const S t1 = end_time();
        const mask open = accepted & !events.locating(), none = mask(false);
        return breaking_points<Model, Method, S>{args, s}.locate({s, trial, t1, open, none});
    }

    /// Only hooks see the step just taken.
    static constexpr bool shows_step = has_after_step<Model> || has_after_event<Model> || has_after_stop<Model> ||
                                       has_triggers<Model> || has_finalise<Model>;
    /// Why the trial of lane i, which is stuck, failed.
    MYRIAD_FUNCTION status failure_of(int i, [[maybe_unused]] const event_driver_type& events) {
        if constexpr (stochastic_method<Method> && has_events<Model>) {
            if (events.is_stuck(i)) return status::event_accumulation;
        }
        if constexpr (has_delays<Model>) {
            const auto is_in = [&](std::uint8_t trouble) MYRIAD_LAMBDA {
                return team_for<Model>::any((s.data.past.lane[i].trouble & trouble) != 0);
            };
            if (is_in(past_trouble::lost)) return status::history_overflow;
            if (is_in(past_trouble::invalid)) return status::invalid_delay;
            if (is_in(past_trouble::not_yet) && !is_adaptive<Method>) return status::invalid_delay;
        }
        return stepping_type{args, s}.failure_of(i);
    }
    /// Time at the end of the trial.
    MYRIAD_FUNCTION S end_time() { return stepping_type{args, s}.end_time(); }
};

/// Integrates all instances that `source.next()` returns (indices, then -1) on one pack of lanes of kind S. The source
/// of a CUDA thread also says whether it `gives_only_one()`. One that the host can stop says whether it `gives_up()`, a
/// CPU's after so many iterations, and whether it `gives_up_before(phases left)`, which both end what is under way; and
/// whether the call `is_over()` for the instance given last, which then stays as it is. Returns the number of
/// iterations of the loop, each a trial step in every lane. `shared` replaces `args.shared` where a backend has moved
/// these parameters.
template <class Model, class Method, class S, class Source>
MYRIAD_FUNCTION std::int64_t integrate(const kernel_arguments<Model, real_of<S>>& args,
                                       const shared_parameters<real_of<S>>& shared, Source& source) {
    static_assert(hooks_fit<Model, real_of<S>>);
    static_assert(noise_fits<Model, Method, real_of<S>>);
    static_assert(stepper<Method, Model, S>);
    static_assert(delays_fit<Model, Method>);
    event_memories<Model, real_of<S>, lanes_of<S>> memory;  // outside the loop's own state, which is in registers
    integrator<Model, Method, S> loop{args, {}, {}, &memory};
    loop.run(source, shared);
    return loop.s.all_iterations_of(args);
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
