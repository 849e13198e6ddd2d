// SPDX-License-Identifier: MIT
// THE loop: takes every instance a source hands out through its phases, step by step, on one pack of lanes. A lane that
// ends its instance takes the next one, so no lane waits for another. The same body is the CUDA kernel (one lane) and
// the OpenMP backend's inner loop (a pack of lanes).
#pragma once

#include "myriad/kernel/controller/adaptive.hpp"
#include "myriad/kernel/controller/fixed.hpp"
#include "myriad/kernel/controller/initial_step.hpp"
#include "myriad/kernel/event/locator.hpp"
#include "myriad/kernel/integrator/hook_driver.hpp"
#include "myriad/kernel/integrator/phase.hpp"
#include "myriad/kernel/output/reducer.hpp"
#include "myriad/kernel/state/integration_state.hpp"
#include "myriad/kernel/stepper/dense_output.hpp"
#include "myriad/kernel/stepper/step.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class S>
struct integrator {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr int n = n_state<Model>;
    static constexpr int m = n_event<Model>;
    static constexpr bool adaptive = is_adaptive<Method>;
    static constexpr bool samples = samples_trajectory<Method>;
    using iteration_number = typename integration_state<Model, Method, S>::iteration_number;
    using trial_type = trial_step<Method, S, n>;
    using event_locator_type = event_locator<Model, Method, S>;

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S> s;
    event_sides<Model, S> e;
    sample_state<Method, S> o;
    event_memory<Model, R>* memory;  // of the lanes

    template <class Source>
    MYRIAD_FUNCTION void run(Source& source, const shared_parameters<R>& shared) {
        clear(shared);
        event_locator_type locator{args, s, e, memory};
        fired_events<Model, S> events;
        if constexpr (has_events<Model>) {
            events.clear();
            e.clear();
        }
        while (fill_lanes(source, locator)) {
            MYRIAD_REJOIN;
            if constexpr (runs_freely) run_freely();
            trial_type trial;
            propose_step(locator);
            take_step(trial);
            mask accepted = judge(trial, locator, events);
            if constexpr (samples) sampler<Model, Method, S>{args, s, o}.save(trial, end_time(), accepted);
            mask reduced;
            if constexpr (has_reductions<Model>)
                reduced = reducer<Model, Method, S>{s}.reduce(trial, end_time(), accepted);
            commit(trial, accepted, events);
            hook_driver<Model, Method, S> hooks{args, s, locator, events};
            if constexpr (sees_reductions<Model>) hooks.follow_reductions(reduced);
            if constexpr (has_after_step<Model>) hooks.after_step(accepted);
            if constexpr (has_events<Model>) hooks.act_on_events();
        }
        if constexpr (requires { source.gives_only_one(); })
            phase_driver<Model, Method, S>{args, s, locator, o}.finish(0);
    }

    /// An empty pack: every lane asks for an instance.
    MYRIAD_FUNCTION void clear(const shared_parameters<R>& shared) {
        s.data.shared = shared.real;
        s.data.shared_integer = shared.integer;
        s.active = mask(false);
        s.ended = mask(true);
        s.iteration = 0;
        s.next_look = 0;
        s.all_iterations = 0;
        MYRIAD_UNROLL
        for (int i = 0; i < lanes_of<S>; ++i) s.instance[i] = -1;
    }

    /// Takes lanes whose phase has ended to their next phase or instance. Returns false when no lane is left running.
    template <class Source>
    MYRIAD_FUNCTION bool fill_lanes(Source& source, event_locator_type& locator) {
        if (!any(s.ended)) {
            if (!time_to_look()) return true;
            look_at_long_phases();
            if (!any(s.ended)) {
                plan_next_look();
                return true;
            }
        } else if constexpr (is_pack<S>) {
            look_at_long_phases();  // of the other lanes
        }
        mask begun = mask(false);
        for_each_lane(s.ended, [&](int i) MYRIAD_LAMBDA {
            const auto* arguments = &args;
            MYRIAD_FORGET(arguments);  // else what it points to waits in registers through the loop
            set_lane(begun, i, phase_driver<Model, Method, S>{*arguments, s, locator, o}.advance(i, source));
        });
        s.ended = mask(false);
        plan_next_look();
        if constexpr (chooses_first_step<Method>) {
            const mask open = begun & s.first_step_open;
            if (any(open)) detail::choose_first_step(args, s, open);
        }
        if constexpr (keeps_slope && !loses_slope) s.renew_slope(begun);
        if constexpr (has_events<Model>) locator.begin(begun);
        return any(s.active);
    }

    /// Takes the fixed steps that nobody looks at, up to the first lane's last step, in registers and with one check
    /// per block. What is not finite once stays so: a block that ends with such a value is taken back and halved, and
    /// the ordinary step after it finds the one to blame.
    MYRIAD_FUNCTION void run_freely() {
        constexpr iteration_number worthwhile = 4, longest_block = 128;
        iteration_number run = iterations_to_look(s.iteration);  // less the last one, which is looked at
        if constexpr (is_pack<S>) run = s.next_look - s.iteration;
        run -= 1;
        R lane_step = R(0);
        for_each_lane(s.running(), [&](int i) MYRIAD_LAMBDA {
            const auto left = static_cast<iteration_number>(get_lane(s.left, i)) - 1;
            run = left < run ? left : run;
            lane_step = get_lane(s.step, i);
        });
        if (run < worthwhile) return;
        // One step size for all lanes is one register; lanes that part in direction take ordinary steps.
        const S step = S(lane_step), base = s.base;
        if (any(s.running() & (s.step != step))) return;
        const inputs<Model, S> p = s.data;
        vec<S, n> y = s.data.y;
        count done = s.done;
        iteration_number taken = 0, block = longest_block;
        while (taken < run) {
            block = block < run - taken ? block : run - taken;
            vec<S, n> now = y;
            MYRIAD_UNROLL_BY_FOUR
            for (iteration_number i = 0; i < block; ++i) {
                trial_type trial;
                const S t = fma(S(done + count(static_cast<lane_of<count>>(i))), step, base);
                trial.k[0] = detail::evaluate_rhs<Model>(t, now, p);
                detail::take_trial_step<Method, Model>(t, step, t + step, now, p, trial);
                now = trial.y;
            }
            if (MYRIAD_UNLIKELY(any(s.running() & !all_finite(now)))) {
                if (block == 1) break;
                block /= 2;
                continue;
            }
            y = now;
            done = done + count(static_cast<lane_of<count>>(block));
            taken += block;
        }
        s.data.y = y;
        s.left = s.left - (done - s.done);
        s.done = done;
        s.iteration += taken;
    }

    /// The length of the next trial and the slope at its start.
    MYRIAD_FUNCTION void propose_step(event_locator_type& locator) {
        if constexpr (adaptive) {
            detail::propose_adaptive_step(s);
        } else {
            detail::propose_fixed_step(args, s);
        }
        if constexpr (has_events<Model>) locator.propose_step();
        if constexpr (keeps_slope && loses_slope) {
            if constexpr (adaptive && !Method::first_same_as_last) {
                s.renew_slopes();
            } else {
                s.renew_slope(mask(true));
            }
        }
    }

    MYRIAD_FUNCTION void take_step(trial_type& trial) {
        ++s.iteration;
        if constexpr (keeps_slope) {
            trial.k[0] = s.slope;
        } else {
            trial.k[0] = detail::evaluate_rhs<Model>(s.now(), s.data.y, s.data);
        }
        detail::take_trial_step<Method, Model>(s.now(), s.h, end_time(), s.data.y, s.data, trial);
    }

    /// Accepts or rejects the trial: error, finiteness, and that it does not go beyond an event.
    MYRIAD_FUNCTION mask judge(const trial_type& trial, event_locator_type& locator, fired_events<Model, S>& events) {
        mask accepted;
        const S t1 = end_time();
        if constexpr (knows_slope_end) s.slope_end_known = mask(false);
        if constexpr (has_events<Model>) {
            const auto g1 = detail::evaluate_events<Model>(t1, trial.y, s.data);
            mask valid = !e.undefined;
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j) valid = valid & (g1[j] == g1[j]);
            accepted = control(trial, t1, valid);
            locator.look(trial, t1, g1, accepted, events);
        } else {
            accepted = control(trial, t1, mask(true));
        }
        return accepted;
    }

    /// Makes the accepted lanes' new state the committed one.
    MYRIAD_FUNCTION void commit(const trial_type& trial, const mask& accepted, const fired_events<Model, S>& events) {
        MYRIAD_UNROLL
        for (int c = 0; c < n; ++c) s.data.y[c] = select(accepted, trial.y[c], s.data.y[c]);
        if constexpr (shows_step) s.data.h = select(accepted, s.h, s.data.h);
        [[maybe_unused]] const S t1 = end_time();
        if constexpr (adaptive) {
            if constexpr (keeps_low) s.time_low = select(accepted, (s.h + s.time_low) - (t1 - s.data.t), s.time_low);
            s.data.t = select(accepted, t1, s.data.t);
            // The last step ends there, and so may one before it, by rounding or at an event.
            s.ended = s.ended | (accepted & (t1 == s.data.t_end));
        } else {
            s.done = count_where(accepted, s.done);
            s.left = select(accepted, s.left - count(1), s.left);
            if constexpr (has_events<Model>) {
                for_each_lane(accepted & events.which.any_of() & !s.final_step, [&](int i) MYRIAD_LAMBDA {
                    // the last step taken was shorter than the others
                    set_lane(s.time_low, i, get_lane(s.time_low, i) + (get_lane(s.h, i) - get_lane(s.step, i)));
                    detail::move_fixed_steps(args, s, i, get_lane(t1, i));
                });
            }
            if constexpr (shows_time) {
                s.data.t = s.now();
                for_each_lane(accepted & s.final_step,
                              [&](int i) MYRIAD_LAMBDA { set_lane(s.data.t, i, detail::domain_end(args, s, i)); });
            }
        }
        if constexpr (keeps_slope) {
            if constexpr (Method::first_same_as_last) {
                MYRIAD_UNROLL
                for (int c = 0; c < n; ++c) s.slope[c] = select(accepted, trial.slope_end()[c], s.slope[c]);
            } else {
                s.slope_valid = s.slope_valid & !accepted;
                if constexpr (knows_slope_end) {
                    const mask known = accepted & s.slope_end_known;
                    MYRIAD_UNROLL
                    for (int c = 0; c < n; ++c) s.slope[c] = select(known, s.slope_end[c], s.slope[c]);
                    s.slope_valid = s.slope_valid | known;
                }
            }
        }
        if constexpr (!adaptive) {
            s.ended = s.ended | (accepted & s.final_step);
            if constexpr (has_events<Model>)
                s.ended = s.ended | (accepted & events.which.any_of() & (s.data.t == s.data.t_end));
        }
    }

    /// Iterations that a phase of so many iterations has before it is looked at again.
    MYRIAD_FUNCTION iteration_number iterations_to_look(iteration_number iterations) const {
        iteration_number left = args.max_steps - iterations;
        if constexpr (adaptive) {
            const iteration_number next = creep_interval - iterations % creep_interval;
            left = next < left ? next : left;
        }
        return left;
    }
    /// A pack looks when the first of its phases is to be looked at; one instance alone needs to keep no such
    /// iteration.
    MYRIAD_FUNCTION void plan_next_look() {
        if constexpr (is_pack<S>) {
            s.next_look = s.iteration + args.max_steps;
            for_each_lane(s.active, [&](int i) MYRIAD_LAMBDA {
                const iteration_number next = s.iteration + iterations_to_look(s.iteration - s.phase_start[i]);
                s.next_look = next < s.next_look ? next : s.next_look;
            });
        }
    }
    /// Whether a phase has taken as many iterations as it may, or is to be looked at for whether it creeps.
    MYRIAD_FUNCTION bool time_to_look() const {
        if constexpr (is_pack<S>) {
            return s.iteration >= s.next_look;
        } else if constexpr (adaptive) {
            return s.iteration >= args.max_steps || s.iteration % creep_interval == 0;
        } else {
            return s.iteration >= args.max_steps;
        }
    }
    /// Ends phases that have taken as many trial steps as the options allow, and those that creep.
    MYRIAD_FUNCTION void look_at_long_phases() {
        for_each_lane(s.running() & !s.ended, [&](int i) MYRIAD_LAMBDA {
            const iteration_number iterations = s.iteration - s.phase_start[i];
            if (iterations >= args.max_steps) s.end_lane(i, status::max_steps);
            if constexpr (adaptive) {
                if (iterations == 0 || iterations % creep_interval != 0) return;
                const auto* arguments = &args;
                MYRIAD_FORGET(arguments);  // else what it points to waits in registers through the loop
                if (detail::creeps(*arguments, s, i)) s.end_lane(i, status::not_finite);
            }
        });
    }

private:
    using count = typename integration_state<Model, Method, S>::count;

    static constexpr bool runs_freely = !adaptive && !has_events<Model> && !has_after_step<Model> && !samples &&
                                        !has_reductions<Model> && !Method::first_same_as_last;
    /// Slopes are worth keeping where a step may be repeated or its last slope is the next one's first.
    static constexpr bool keeps_slope = stepper_keeps_slope<Model, Method>;
    /// Within a phase too, the slope may have to be computed anew.
    static constexpr bool loses_slope =
        !Method::first_same_as_last || has_after_step<Model> || has_events<Model> || sees_reductions<Model>;
    /// Samples and reductions may need the slope at the end of a step, which is then the first of the next.
    static constexpr bool knows_slope_end = samples || has_reductions<Model>;
    static constexpr bool keeps_low = keeps_time_low<Model, Method, R>;
    /// Only hooks see the step just taken.
    static constexpr bool shows_step = has_after_step<Model> || has_after_event<Model> || has_finalise<Model>;
    /// Fixed steps count time; it is only written down where someone looks at it.
    static constexpr bool shows_time = has_after_step<Model> || has_events<Model>;

    /// Time at the end of the trial.
    MYRIAD_FUNCTION S end_time() const {
        S t1;
        if constexpr (!adaptive) {
            // the time at which the next step begins, bit for bit, so that it may take over the slope
            t1 = fma(S(s.done + count(1)), s.step, s.base);
            if constexpr (has_events<Model>) {
                const S redone = s.now() + (s.h + s.time_low);  // to an event
                t1 = select(s.h == s.step, t1, redone);
            }
        } else if constexpr (keeps_low) {
            t1 = s.data.t + (s.h + s.time_low);
        } else {
            t1 = s.data.t + s.h;
        }
        return select(s.final_step, s.data.t_end, t1);
    }

    MYRIAD_FUNCTION mask control(const trial_type& trial, const S& t1, const mask& valid) {
        if constexpr (adaptive) {
            mask may_stick = s.running();
            if constexpr (has_events<Model>)
                may_stick = may_stick & !e.locating;  // a flight shorter than the resolution of t
            return detail::control_step(args, s, trial, t1, valid, may_stick);
        } else {
            const mask finite = valid & all_finite(trial.y);
            const mask failed = s.running() & !finite;
            if (MYRIAD_UNLIKELY(any(failed))) {
                s.rejected = count_where(failed, s.rejected);
                s.end_lanes(failed, status::not_finite);
            }
            return s.running() & finite;
        }
    }
};

/// Integrates all instances that `source.next()` hands out (indices, then -1) on one pack of lanes of kind S. The
/// source of a CUDA thread also says whether it `gives_only_one()`. Returns the iterations that the loop took, each a
/// trial step in every lane. `shared` stands for `args.shared` where a backend has moved them.
template <class Model, class Method, class S, class Source>
MYRIAD_FUNCTION std::int64_t integrate(const kernel_arguments<Model, real_of<S>>& args,
                                       const shared_parameters<real_of<S>>& shared, Source& source) {
    static_assert(hooks_fit<Model, real_of<S>>);
    event_memory<Model, real_of<S>> memory[lanes_of<S>] = {};  // beside the loop's own, which lies in registers
    integrator<Model, Method, S> loop{args, {}, {}, {}, memory};
    loop.run(source, shared);
    return loop.s.all_iterations + loop.s.iteration;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
