// SPDX-License-Identifier: MIT
// Adaptive steps by the embedded error estimate: proposes a step, judges the trial, and sets the next length.
#pragma once

#include "myriad/kernel/controller/fast_power.hpp"
#include "myriad/kernel/controller/norm.hpp"
#include "myriad/kernel/controller/step_decision.hpp"
#include "myriad/kernel/state/integration_state.hpp"
#include "myriad/kernel/stepper/component_loop.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// A step is this part of the longest that the error estimate allows, as in the MPGOS package.
inline constexpr double safety_factor = 0.9;
/// Binary logarithm of 1e-4, as in Hairer and Wanner's DOPRI5.
inline constexpr double least_error_remembered = -13.2877;

/// Stepping (see stepping.hpp) with a step size of its own in every lane.
template <class Model, class Method, class S>
struct adaptive_stepping {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr auto n = n_state<Model>;
    static constexpr bool keeps_low = keeps_time_low<Model, Method, R>;
    static constexpr std::int32_t stagnation_interval = 1024;
    using C = control_of<S>;  // less precise in CUDA threads
    using L = real_of<C>;

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S>& s;

    MYRIAD_FUNCTION void load(int i) {
        const std::int64_t index = s.instance[i];
        set_lane(s.data.h_next, i, args.h_next[index]);
        if constexpr (scales_tolerances<Method>) set_lane(s.steps.tolerance_scale, i, args.tolerance_scale[index]);
    }
    MYRIAD_FUNCTION void store(int i) const { args.h_next[s.instance[i]] = get_lane(s.data.h_next, i); }

    MYRIAD_FUNCTION void choose_step(int i, std::int32_t phase) {
        // A method with fixed steps leaves no step size to carry on with.
        const bool restart = !args.carry_step || phase == 0 || get_lane(s.data.h_next, i) == R(0);
        if (restart) set_lane(s.data.h_next, i, args.first_change > R(0) ? R(0) : args.step);
    }
    MYRIAD_FUNCTION void begin(int i, R t) {
        if constexpr (remembers_errors<Method>) {
            set_lane(s.steps.errors.last, i, 0);
            set_lane(s.steps.errors.before, i, 0);
        }
        set_lane(s.steps.time_low, i, R(0));
        set_lane(s.steps.last_not_finite, i, false);
        // Zero: to be chosen when the slope is known. A step that t does not resolve would be none.
        const R h = abs(get_lane(s.data.h_next, i));
        if (h == R(0)) return;
        set_lane(s.data.h_next, i, copysign(max(h, resolved_roundings<R> * abs(t)), get_lane(s.data.t_end, i) - t));
        s.bound_step(args, i);
    }
    MYRIAD_FUNCTION void move(int, R) {}
    MYRIAD_FUNCTION void resume(int i, R h) { set_lane(s.data.h_next, i, h); }
    MYRIAD_FUNCTION R time(int i) const { return get_lane(s.data.t, i); }

    /// The next step of every lane: the proposed one, or the rest of the way to the next stop; the former in lanes that
    /// are `locating` an event before that. A step that falls short of the stop by less than 1/1024 of itself is
    /// stretched, so that no sliver remains; its error is tested as usual. The state advances by exactly the same step
    /// as t; otherwise the difference would accumulate.
    MYRIAD_FUNCTION void propose(const mask& locating) {
        S remaining = s.t_stop() - s.data.t;
        if constexpr (keeps_low) remaining = remaining - s.steps.time_low;
        s.final_step = (abs(remaining) <= abs(s.data.h_next) * S(R(1 + 1.0 / 1024))) & !locating;
        S h = copysign(s.data.h_next, remaining);
        if (!keeps_low_now()) h = (s.data.t + h) - s.data.t;
        s.h = select(s.final_step, remaining, h);
    }

    MYRIAD_FUNCTION S end_time() const {
        const S t1 = keeps_low ? s.data.t + (s.h + s.steps.time_low) : s.data.t + s.h;
        return select(s.final_step, s.t_stop(), t1);
    }

    /// Accepts or rejects the trial of every lane and chooses the next step, by the elementary (I) controller of the
    /// MPGOS package: factor 0.9 q^(-1/(p+1)) after an accepted and 0.9 q^(-1/p) after a rejected step, with q the
    /// largest ratio of error to tolerance and p the order of the error estimate, within the options' limits (Hairer,
    /// Norsett, Wanner, Solving ODE I, II.4, eq. (4.13)); or by the controller chosen with `controlled`. Lanes whose
    /// trial is not finite (or not `valid`, or singular) are rejected with the smallest factor. Lanes rejected at the
    /// minimum step are stuck; so are those whose step does not advance t (it ends, at `t1`, where it began).
    template <class EndStuck>
    MYRIAD_FUNCTION step_decision<S> judge(const trial_step<Method, S, n>& trial, const S& t1, mask valid,
                                           EndStuck&& end_stuck) {
        if constexpr (solves_linear_systems<Method>) valid = valid & !trial.singular;
        error_norm<S> error = detail::scaled_error<Model, Method>(args, s.data.y, s.h, trial);
        if constexpr (scales_tolerances<Method>)
            error.worst = static_cast<C>(error_ratio(S(error.worst), s.steps.tolerance_scale));
        valid = valid & error.finite;
        const mask within = valid & (error.worst <= C(L(1)));
        mask accepted = s.running() & within;
        mask stuck = mask(false);
        C factor = factor_of_step(error.worst, within, accepted);
        const mask rejected = s.running() & !within;
        if (any(rejected)) {
            const mask finite = valid & (error.worst > C(L(1))) & (error.worst <= C(largest_of<L>));
            factor = select(within | finite, factor, C(static_cast<L>(args.shrink_limit)));
            // At a few roundings of t, nine tenths of the step may round to the same step.
            const S rounding = S(epsilon_of<R>) * abs(s.data.t);
            if (!keeps_low_now())
                factor = select(rejected & (abs(s.h) <= S(R(16)) * rounding), smaller(factor, C(L(safety_factor / 2))),
                                factor);
            // A step of length zero does not show why the previous one failed.
            const mask moved = rejected & (s.h != S(R(0)));
            s.steps.last_not_finite = select(moved, !finite, s.steps.last_not_finite);
            // Where the right-hand side itself is not finite, there is no Jacobian.
            if constexpr (solves_linear_systems<Method>) {
                mask singular = trial.singular;
                detail::each_component<Method, n_state<Model>>(
                    [&](int c) MYRIAD_LAMBDA { singular = singular & is_finite(trial.slope_start()[c]); });
                s.steps.last_singular = select(moved & !finite, singular, s.steps.last_singular);
            }
            stuck = rejected & (abs(s.h) <= S(args.minimum_step) + rounding);
        }
        S next = s.h * S(factor);
        const S minimum = S(args.minimum_step), maximum = S(args.maximum_step);
        const mask ends = accepted & (t1 == s.t_stop());
        const mask still = s.running() & (t1 == s.data.t);
        // One branch for all that is rare.
        if (MYRIAD_UNLIKELY(any(ends | still | stuck | (s.running() & !clearly_between(minimum, next, maximum))))) {
            S size = limited(abs(next), minimum, maximum);
            // A step cut short by a stop says little about the step size to continue with.
            size = select(ends, larger(size, abs(s.data.h_next)), size);
            next = copysign(size, s.h);
            accepted = accepted & !end_stuck(stuck, still);
        }
        return {accepted, next};
    }
    /// Why the trial of lane i, which is stuck, failed.
    MYRIAD_FUNCTION status failure_of(int i) const {
        if (!get_lane(s.steps.last_not_finite, i)) return status::step_underflow;
        if constexpr (solves_linear_systems<Method>)
            if (get_lane(s.steps.last_singular, i)) return status::singular_jacobian;
        return status::not_finite;
    }

    MYRIAD_FUNCTION mask advance(const mask& accepted, const S& t1, const mask&) {
        if (keeps_low_now())
            s.steps.time_low = select(accepted, (s.h + s.steps.time_low) - (t1 - s.data.t), s.steps.time_low);
        s.data.t = select(accepted, t1, s.data.t);
        // The last step ends there; an earlier one may, by rounding or at an event.
        return accepted & (t1 == s.data.t_end);
    }

    /// Whether lane i stagnates before a point where its right-hand side has no value: at the pace of its last
    /// `stagnation_interval` iterations, `max_steps` of them would take t neither to t_end, nor on by the time since
    /// t_begin or by the first step. Where t is finer than the state, a step too short to change the state succeeds and
    /// the next, longer one fails, for ever. To be called after that many iterations each time, or fewer before the
    /// first: the ensemble's array of times, unused within a phase, holds t at the last check.
    MYRIAD_FUNCTION bool stagnates(int i) {
        const std::int64_t index = s.instance[i];
        const R t = get_lane(s.data.t, i), gained = abs(t - args.t[index]);
        team_for<Model>::synchronise();  // all have read it
        args.t[index] = t;
        if (!get_lane(s.steps.last_not_finite, i)) return false;
        const R t_begin = args.t_begin != nullptr ? args.t_begin[index] : args.common_t_begin;
        const R goal = min(abs(get_lane(s.data.t_end, i) - t), max(abs(t - t_begin), args.step));
        return gained * (static_cast<R>(args.max_steps) / R(stagnation_interval)) < goal;
    }

private:
    /// `keeps_low`, and known only at run time where the number of events is.
    static MYRIAD_FUNCTION bool keeps_low_now() {
        return keeps_low && (std::is_same_v<R, float> || !has_events<Model> || MYRIAD_LENGTH(n_event<Model>) > 0);
    }
    /// The ratio of the next step to the last one, from `worst`, the ratio of error to tolerance.
    MYRIAD_FUNCTION C factor_of_step(const C& worst, const mask& within, const mask& accepted) {
        constexpr int order = estimate_order<Method>;
        const L after_accepted = L(-1.0 / (order + 1)), after_rejected = L(-1.0 / order);
        C factor;
        if constexpr (remembers_errors<Method>) {
            auto& errors = s.steps.errors;
            const C now = fast_log2(worst);
            C sum = fma(C(L(Method::exponent_last)), errors.last, C(L(Method::exponent_now)) * now);
            if constexpr (Method::exponent_before != 0) sum = fma(C(L(Method::exponent_before)), errors.before, sum);
            factor = C(L(safety_factor)) * fast_exp2(select(within, sum * C(after_accepted), now * C(after_rejected)));
            // An error of zero counts as 1e-4: a smaller one would shorten the next steps needlessly.
            errors.before = select(accepted, errors.last, errors.before);
            errors.last = select(accepted, larger(now, C(L(least_error_remembered))), errors.last);
        } else {
            factor = C(L(safety_factor)) * fast_power(worst, select(within, C(after_accepted), C(after_rejected)));
        }
        return limited(factor, C(static_cast<L>(args.shrink_limit)), C(static_cast<L>(args.growth_limit)));
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
