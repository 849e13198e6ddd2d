// SPDX-License-Identifier: MIT
// THE loop: takes every instance a source hands out through its phases, step by step, on one pack of lanes. A lane that
// ends its instance takes the next one, so no lane waits for another. The same body is the CUDA kernel (one lane) and
// the OpenMP backend's inner loop (a pack of lanes).
#pragma once

#include "myriad/controller/adaptive.hpp"
#include "myriad/controller/fixed.hpp"
#include "myriad/controller/initial_step.hpp"
#include "myriad/event/locator.hpp"
#include "myriad/integrator/actions.hpp"
#include "myriad/integrator/phase.hpp"
#include "myriad/integrator/state.hpp"
#include "myriad/stepper/dense_output.hpp"
#include "myriad/stepper/step.hpp"

namespace myriad::inline MYRIAD_TARGET {

template <class Model, class Method, class S>
struct integrator {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr int n = n_state<Model>;
    static constexpr int m = n_event<Model>;
    static constexpr bool adaptive = is_adaptive<Method>;
    static constexpr bool samples = samples_trajectory<Method>;
    using turn_number = typename integration_state<Model, Method, S>::turn_number;
    using trial_step = rk_trial<Method, S, n>;
    using locator = event_locator<Model, Method, S>;

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S> s;
    event_state<Model, S> e;
    sample_state<Method, S> o;

    template <class Source>
    MYRIAD_FUNCTION void run(Source& source, const shared_parameters<R>& shared) {
        clear(shared);
        while (fill_lanes(source)) {
            MYRIAD_REJOIN;
            if constexpr (runs_freely) run_freely();
            trial_step trial;
            propose_step();
            take_step(trial);
            mask accepted = judge(trial);
            if constexpr (samples) sampler<Model, Method, S>{args, s, o}.save(trial, end_time(), accepted);
            commit(trial, accepted);
            hook_driver<Model, Method, S> hooks{args, s, e};
            if constexpr (has_after_step<Model>) hooks.after_step(accepted);
            if constexpr (has_events<Model>) hooks.act_on_events();
        }
        if constexpr (requires { source.gives_only_one(); }) phase_driver<Model, Method, S>{args, s, e, o}.finish(0);
    }

    /// An empty pack: every lane asks for an instance.
    MYRIAD_FUNCTION void clear(const shared_parameters<R>& shared) {
        s.data.shared = shared.real;
        s.data.shared_integer = shared.integer;
        s.active = mask(false);
        s.ended = mask(true);
        s.turn = 0;
        s.first_start = 0;
        s.all_turns = 0;
        MYRIAD_UNROLL
        for (int i = 0; i < lanes_of<S>; ++i) s.instance[i] = -1;
    }

    /// Takes lanes whose phase has ended to their next phase or instance. Returns false when no lane is left running.
    template <class Source>
    MYRIAD_FUNCTION bool fill_lanes(Source& source) {
        if (!any(s.ended)) {
            if (s.turn - s.first_start < args.max_steps) return true;
            end_long_phases();
        } else if constexpr (lanes_of<S> > 1) {
            end_long_phases();  // of the other lanes
        }
        mask begun = mask(false);
        for_each_lane(s.ended, [&](int i) MYRIAD_LAMBDA {
            const auto* arguments = &args;
            MYRIAD_FORGET(arguments);  // else what it points to waits in registers through the loop
            set_lane(begun, i, phase_driver<Model, Method, S>{*arguments, s, e, o}.advance(i, source));
        });
        s.ended = mask(false);
        if constexpr (lanes_of<S> > 1) {
            s.first_start = s.turn;
            for_each_lane(s.active, [&](int i) MYRIAD_LAMBDA {
                s.first_start = s.phase_start[i] < s.first_start ? s.phase_start[i] : s.first_start;
            });
        }
        if constexpr (chooses_first_step<Method>) {
            const mask open = begun & s.first_step_open;
            if (any(open)) choose_first_step(args, s, open);
        }
        if constexpr (keeps_slope && !loses_slope) s.renew_slope(begun);
        if constexpr (has_events<Model>) locator{args, s, e}.begin(begun);
        return any(s.active);
    }

    /// Takes the fixed steps that nobody looks at, up to the first lane's last step, in registers and with one check per
    /// block. What is not finite once stays so: a block that ends with such a value is taken back and halved, and the
    /// ordinary step after it finds the one to blame.
    MYRIAD_FUNCTION void run_freely() {
        constexpr turn_number worthwhile = 4, longest_block = 128;
        turn_number run = args.max_steps - (s.turn - s.first_start) - 1;  // the last one is looked at
        R lane_step = R(0);
        for_each_lane(s.running(), [&](int i) MYRIAD_LAMBDA {
            const auto left = static_cast<turn_number>(get_lane(s.left, i)) - 1;
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
        turn_number taken = 0, block = longest_block;
        while (taken < run) {
            block = block < run - taken ? block : run - taken;
            vec<S, n> now = y;
            MYRIAD_UNROLL_BY_FOUR
            for (turn_number i = 0; i < block; ++i) {
                trial_step trial;
                const S t = fma(S(done + count(static_cast<lane_of<count>>(i))), step, base);
                trial.k[0] = evaluate_rhs<Model>(t, now, p);
                take_trial_step<Method, Model>(t, step, t + step, now, p, trial);
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
        s.turn += taken;
    }

    /// The length of the next trial and the slope at its start.
    MYRIAD_FUNCTION void propose_step() {
        if constexpr (adaptive) {
            propose_adaptive_step(s);
        } else {
            propose_fixed_step(args, s);
        }
        if constexpr (has_events<Model>) {
            s.h = select(e.locating, e.h_redo, s.h);
            s.final_step = s.final_step & !e.locating;
        }
        if constexpr (keeps_slope && loses_slope) {
            if constexpr (adaptive && !Method::first_same_as_last) {
                s.renew_slopes();
            } else {
                s.renew_slope(mask(true));
            }
        }
    }

    MYRIAD_FUNCTION void take_step(trial_step& trial) {
        ++s.turn;
        if constexpr (keeps_slope) {
            trial.k[0] = s.slope;
        } else {
            trial.k[0] = evaluate_rhs<Model>(s.now(), s.data.y, s.data);
        }
        take_trial_step<Method, Model>(s.now(), s.h, end_time(), s.data.y, s.data, trial);
    }

    /// Accepts or rejects the trial: error, finiteness, and that it does not go beyond an event.
    MYRIAD_FUNCTION mask judge(const trial_step& trial) {
        mask accepted;
        const S t1 = end_time();
        if constexpr (knows_slope_end) s.slope_end_known = mask(false);
        if constexpr (has_events<Model>) {
            const auto g1 = evaluate_events<Model>(t1, trial.y, s.data);
            mask valid = mask(true);
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j) valid = valid & (g1[j] == g1[j]) & (e.value[j] == e.value[j]);
            accepted = control(trial, t1, valid);
            locator locate{args, s, e};
            locate.forget(!accepted);
            locate.locate(trial, t1, g1, accepted);
        } else {
            accepted = control(trial, t1, mask(true));
        }
        return accepted;
    }

    /// Makes the accepted lanes' new state the committed one.
    MYRIAD_FUNCTION void commit(const trial_step& trial, const mask& accepted) {
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
                for_each_lane(accepted & any_event(e.firing) & !s.final_step, [&](int i) MYRIAD_LAMBDA {
                    // the last step taken was shorter than the others
                    set_lane(s.time_low, i, get_lane(s.time_low, i) + (get_lane(s.h, i) - get_lane(s.step, i)));
                    move_fixed_steps(args, s, i, get_lane(t1, i));
                });
            }
            if constexpr (shows_time) {
                s.data.t = s.now();
                for_each_lane(accepted & s.final_step,
                              [&](int i) MYRIAD_LAMBDA { set_lane(s.data.t, i, domain_end(args, s, i)); });
            }
        }
        if constexpr (keeps_slope) {
            if constexpr (Method::first_same_as_last) {
                MYRIAD_UNROLL
                for (int c = 0; c < n; ++c)
                    s.slope[c] = select(accepted, trial.slope_end()[c], s.slope[c]);
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
            if constexpr (has_events<Model>) s.ended = s.ended | (accepted & s.slope_end_known & (s.data.t == s.data.t_end));
        }
    }

    /// Ends phases that have taken as many trial steps as the options allow.
    MYRIAD_FUNCTION void end_long_phases() {
        for_each_lane(s.running() & !s.ended, [&](int i) MYRIAD_LAMBDA {
            if (s.turn - s.phase_start[i] < args.max_steps) return;
            s.end_lane(i, status::max_steps);
        });
    }

private:
    using count = typename integration_state<Model, Method, S>::count;

    static constexpr bool runs_freely = !adaptive && !has_events<Model> && !has_after_step<Model> && !samples &&
                                        !Method::first_same_as_last;
    /// Slopes are worth keeping where a step may be repeated or its last slope is the next one's first.
    static constexpr bool keeps_slope = stepper_keeps_slope<Model, Method>;
    /// Within a phase too, the slope may have to be computed anew.
    static constexpr bool loses_slope = !Method::first_same_as_last || has_after_step<Model> || has_events<Model>;
    /// Events and samples may need the slope at the end of a step, which is then the first of the next.
    static constexpr bool knows_slope_end = has_events<Model> || samples;
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

    MYRIAD_FUNCTION mask control(const trial_step& trial, const S& t1, const mask& valid) {
        if constexpr (adaptive) {
            mask may_stick = s.running();
            if constexpr (has_events<Model>) may_stick = may_stick & !e.locating;  // a flight shorter than the resolution of t
            return control_step(args, s, trial, t1, valid, may_stick);
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

/// Integrates all instances that `source.next()` hands out (indices, then -1) on one pack of lanes of kind S. The source of a
/// CUDA thread also says whether it `gives_only_one()`. Returns the turns the loop took, each a trial step in every lane.
/// `shared` stands for `args.shared` where a backend has moved them.
template <class Model, class Method, class S, class Source>
MYRIAD_FUNCTION std::int64_t integrate(const kernel_arguments<Model, real_of<S>>& args,
                                       const shared_parameters<real_of<S>>& shared, Source& source) {
    static_assert(hooks_fit<Model, real_of<S>>);
    integrator<Model, Method, S> loop{args, {}, {}, {}};
    loop.run(source, shared);
    return loop.s.all_turns + loop.s.turn;
}

}  // namespace myriad::inline MYRIAD_TARGET
