// SPDX-License-Identifier: MIT
// Step-size control by the embedded error estimate: proposes a step, judges a trial, and says how long the next one is.
#pragma once

#include "myriad/kernel/controller/fast_power.hpp"
#include "myriad/kernel/controller/norm.hpp"
#include "myriad/kernel/state/integration_state.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The next step of every lane: the one wanted, or what is left of the domain. A step that falls short of t_end by less
/// than 1/1024 of itself is stretched, so that no sliver is left over; its error is tested like any other. The state
/// advances by exactly the step by which t does, else the difference adds up over the steps.
template <class Model, class Method, class S>
MYRIAD_FUNCTION void propose_adaptive_step(integration_state<Model, Method, S>& s) {
    using R = real_of<S>;
    S remaining = s.data.t_end - s.data.t;
    if constexpr (keeps_time_low<Model, Method, R>) remaining = remaining - s.time_low;
    s.final_step = abs(remaining) <= abs(s.data.h_next) * S(R(1 + 1.0 / 1024));
    S h = copysign(s.data.h_next, remaining);
    if constexpr (!keeps_time_low<Model, Method, R>) h = (s.data.t + h) - s.data.t;
    s.h = select(s.final_step, remaining, h);
}

/// Ends lanes that can make no step, as not_finite or singular_jacobian where that was why their last trial failed.
template <class Model, class Method, class S>
MYRIAD_FUNCTION void end_stuck_lanes(integration_state<Model, Method, S>& s, const mask_of<S>& stuck) {
    if constexpr (solves_linear_systems<Method>)
        s.end_lanes(stuck & s.last_not_finite & s.last_singular, status::singular_jacobian);  // the first status stands
    s.end_lanes(stuck & s.last_not_finite, status::not_finite);
    s.end_lanes(stuck & !s.last_not_finite, status::step_underflow);
}

/// Iterations of the loop after which a phase is looked at for whether it creeps.
inline constexpr std::int32_t creep_interval = 1024;

/// Whether lane i creeps up to where its right-hand side has no value: at the pace of its last `creep_interval`
/// iterations, `max_steps` of them would take t neither to t_end, nor on by the time since t_begin or by the first
/// step. Where t is finer than the state, a step too short to change the state is fine and the next, longer one is not,
/// for ever. To be asked after every so many iterations: the ensemble's array of times, which is of no other use within
/// a phase, holds t at the last look.
template <class Model, class Method, class S>
MYRIAD_FUNCTION bool creeps(const kernel_arguments<Model, real_of<S>>& args,
                            const integration_state<Model, Method, S>& s, int i) {
    using R = real_of<S>;
    const std::int64_t index = s.instance[i];
    const R t = get_lane(s.data.t, i), gained = abs(t - args.t[index]);
    args.t[index] = t;
    if (!get_lane(s.last_not_finite, i)) return false;
    const R t_begin = args.t_begin != nullptr ? args.t_begin[index] : args.common_t_begin;
    const R goal = min(abs(get_lane(s.data.t_end, i) - t), max(abs(t - t_begin), args.step));
    return gained * (static_cast<R>(args.max_steps) / R(creep_interval)) < goal;
}

/// Binary logarithm of 1e-4, as in Hairer and Wanner's DOPRI5.
inline constexpr double least_error_remembered = -13.2877;

/// Accepts or rejects the trial of every lane and sets `data.h_next`, the elementary (I) controller of the MPGOS
/// package: factor 0.9 q^(-1/(p+1)) after an accepted and 0.9 q^(-1/p) after a rejected step, with q the largest ratio
/// of error to tolerance and p the order of the error estimate, kept within the options' limits (Hairer, Norsett,
/// Wanner, Solving ODE I, II.4, eq. (4.13)); or the one chosen with `controlled`. Lanes whose trial is not finite (or
/// not `valid`, or singular) are rejected with the smallest factor. Lanes that are rejected at the minimum step end; so
/// do those in `may_stick` whose step does not advance (`t1`, at which it ends, is where it began). Returns the
/// accepted lanes.
template <class Model, class Method, class S>
MYRIAD_FUNCTION mask_of<S> control_step(const kernel_arguments<Model, real_of<S>>& args,
                                        integration_state<Model, Method, S>& s,
                                        const trial_step<Method, S, n_state<Model>>& trial, const S& t1,
                                        mask_of<S> valid, const mask_of<S>& may_stick) {
    using C = control_of<S>;
    using R = real_of<C>;
    using mask = mask_of<S>;
    if constexpr (solves_linear_systems<Method>) valid = valid & !trial.singular;
    error_norm<S> error = detail::scaled_error<Model, Method>(args, s.data.y, s.h, trial);
    if constexpr (scales_tolerances<Method>)
        error.worst = static_cast<C>(error_ratio(S(error.worst), s.tolerance_scale));
    valid = valid & error.finite;
    const mask within = valid & (error.worst <= C(R(1)));
    mask accepted = s.running() & within;
    constexpr int order = estimate_order<Method>;
    const C shrink_limit = C(static_cast<R>(args.shrink_limit));
    C factor;
    if constexpr (remembers_errors<Method>) {
        const C now = fast_log2(error.worst);
        C sum = fma(C(R(Method::exponent_last)), s.errors.last, C(R(Method::exponent_now)) * now);
        if constexpr (Method::exponent_before != 0) sum = fma(C(R(Method::exponent_before)), s.errors.before, sum);
        factor = C(R(0.9)) * fast_exp2(select(within, sum * C(R(-1.0 / (order + 1))), now * C(R(-1.0 / order))));
        // An error of zero counts as 1e-4: less would shorten the next steps for nothing.
        s.errors.before = select(accepted, s.errors.last, s.errors.before);
        s.errors.last = select(accepted, larger(now, C(R(least_error_remembered))), s.errors.last);
    } else {
        const C exponent = select(within, C(R(-1.0 / (order + 1))), C(R(-1.0 / order)));
        factor = C(R(0.9)) * fast_power(error.worst, exponent);
    }
    factor = limited(factor, shrink_limit, C(static_cast<R>(args.growth_limit)));

    const mask rejected = s.running() & !within;
    if (any(rejected)) {
        const mask finite = valid & (error.worst > C(R(1))) & (error.worst <= C(largest_of<R>));
        factor = select(within | finite, factor, shrink_limit);
        // Of a few roundings of t, nine tenths may be the same step again.
        const S rounding = S(epsilon_of<real_of<S>>) * abs(s.data.t);
        if constexpr (!keeps_time_low<Model, Method, real_of<S>>)
            factor = select(rejected & (abs(s.h) <= S(R(16)) * rounding), smaller(factor, C(R(0.45))), factor);
        s.rejected = count_where(rejected, s.rejected);
        // A step of length zero says nothing about why the one before it failed.
        const mask moved = rejected & (s.h != S(real_of<S>(0)));
        s.last_not_finite = select(moved, !finite, s.last_not_finite);
        // No Jacobian can be had where the right-hand side itself is not finite.
        if constexpr (solves_linear_systems<Method>)
            s.last_singular = select(moved & !finite, trial.singular & all_finite(trial.k[0]), s.last_singular);
        const mask smallest = rejected & (abs(s.h) <= S(args.minimum_step) + rounding);
        if (MYRIAD_UNLIKELY(any(smallest))) detail::end_stuck_lanes(s, smallest);
    }
    S next = s.h * S(factor);
    const S minimum = S(args.minimum_step), maximum = S(args.maximum_step);
    const mask ends = accepted & (t1 == s.data.t_end), stuck = may_stick & (t1 == s.data.t);
    if (MYRIAD_UNLIKELY(any(ends | stuck | (s.running() & !clearly_between(minimum, next, maximum))))) {
        S size = limited(abs(next), minimum, maximum);
        // A step cut short by the end of the domain says little about the step size that goes on from there.
        size = select(ends, larger(size, abs(s.data.h_next)), size);
        next = copysign(size, s.h);
        s.rejected = count_where(stuck & accepted, s.rejected);
        accepted = accepted & !stuck;
        detail::end_stuck_lanes(s, stuck);
    }
    s.data.h_next = select(s.running(), next, s.data.h_next);
    return accepted;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
