// SPDX-License-Identifier: MIT
// The state of one running pack of lanes, shared by the parts of the loop: the instances' data, and what the loop itself
// keeps beside them.
#pragma once

#include <cstdint>
#include <type_traits>
#include <utility>

#include "myriad/controller/choices.hpp"
#include "myriad/controller/kind.hpp"
#include "myriad/ensemble/view.hpp"
#include "myriad/model/hooks.hpp"
#include "myriad/scalar/math.hpp"
#include "myriad/stepper/methods/dense.hpp"
#include "myriad/stepper/step.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// True for methods with an error estimate, whose step size is controlled.
template <class Method>
inline constexpr bool is_adaptive = Method::embedded_order > 0;

/// Slopes are kept where a step may be repeated or where its last slope is the first of the next.
template <class Model, class Method>
inline constexpr bool stepper_keeps_slope =
    is_adaptive<Method> || has_events<Model> || samples_trajectory<Method> || Method::first_same_as_last;

/// Whether the part of the time that rounding takes from t is kept beside it, so that it does not add up: where steps are too
/// short for the resolution of t, as in single precision and to events. Other steps are rounded to that resolution.
template <class Model, class Method, class R>
inline constexpr bool keeps_time_low =
    has_events<Model> || (is_adaptive<Method> ? std::is_same_v<R, float> : writes_time_domain<Model>);

/// Evaluations of the right-hand side in every trial step; others are counted where they happen.
template <class Model, class Method>
inline constexpr int evaluations_per_trial = stepper_keeps_slope<Model, Method> ? Method::stages - 1 : Method::stages;

/// Counts steps of one lane: an integer for one instance, a real (exact up to its mantissa) beside the lanes of a pack.
template <class S>
using count_of = std::conditional_t<lanes_of<S> == 1, std::int32_t, S>;

/// Whether every component is finite, lane by lane.
template <class S, int n>
MYRIAD_FUNCTION mask_of<S> all_finite(const vec<S, n>& y) {
    mask_of<S> finite = is_finite(y[0]);
    MYRIAD_UNROLL
    for (int c = 1; c < n; ++c) finite = finite & is_finite(y[c]);
    return finite;
}

/// The number that one lane of a count holds.
template <class C>
using lane_of = std::conditional_t<std::is_integral_v<C>, C, decltype(get_lane(std::declval<C>(), 0))>;

/// a + amount where the mask holds.
template <class C, class M>
MYRIAD_FUNCTION C count_where(const M& mask, const C& count, int amount = 1) {
    return select(mask, count + C(static_cast<lane_of<C>>(amount)), count);
}

/// Sets the count of lane i.
template <class C, class R>
MYRIAD_FUNCTION void set_count(C& count, int i, R value) {
    if constexpr (std::is_integral_v<C>) {
        count = static_cast<C>(value);
    } else {
        set_lane(count, i, static_cast<real_of<C>>(value));
    }
}

/// Calls `visit(i)` for every lane of the mask.
template <class M, class Visit>
MYRIAD_FUNCTION void for_each_lane(const M& mask, Visit&& visit) {
    if constexpr (plain_number<M>) {
        if (mask) visit(0);
    } else {
        for (std::uint64_t rest = bits(mask); rest != 0; rest &= rest - 1) visit(__builtin_ctzll(rest));
    }
}

/// Binary logarithms of the error over the tolerance of the last accepted step and of the one before; for controllers that
/// look back.
template <class Method, class S, bool remembers = remembers_errors<Method>>
struct control_memory {};
template <class Method, class S>
struct control_memory<Method, S, true> {
    control_of<S> last, before;
};

template <class Model, class Method, class S>
struct integration_state {
    using R = real_of<S>;
    using mask = mask_of<S>;
    using count = count_of<S>;
    static constexpr int lanes = lanes_of<S>;
    // One instance alone counts turns from each phase's start, in one register.
    using turn_number = std::conditional_t<lanes == 1, std::int32_t, std::int64_t>;
    static constexpr int n = n_state<Model>;

    lane_data<Model, S> data;
    mask active;       // lanes that hold an instance
    vec<S, n> slope;   // f at the committed state, where slope_valid holds
    mask slope_valid;
    vec<S, n> slope_end;   // f at the end of the trial, where slope_end_known holds
    mask slope_end_known;
    S time_low;            // what rounding took from t, or from base, where keeps_time_low

    // the trial step
    S h;               // its length, signed
    mask final_step;   // it ends at t_end
    mask last_not_finite;  // the lane's last rejection was for a value that is not finite
    mask last_singular;    // and that value came of a singular matrix, if the method solves linear systems
    mask first_step_open;  // the phase's first step is yet to be chosen
    control_memory<Method, S> errors;  // of earlier steps
    S tolerance_scale;  // of the instance, if the method has it

    // fixed steps: t = base + done * step, so that no rounding adds up and no step is added
    S base, step;
    count done, left;

    // lanes whose phase ends in this turn of the loop, and how
    mask ended;
    myriad::status ending[lanes];
    bool instance_over[lanes];

    // work, per instance
    turn_number turn;                 // turns of the loop; every active lane takes a trial step in each
    turn_number first_start;          // turn at which the oldest running phase began
    turn_number phase_start[lanes];   // turn at which the lane's phase began
    std::int64_t all_turns;           // turns before `turn` was last set back
    count rejected, located, extra_evaluations;
    std::int64_t instance[lanes];          // index, or -1: the lane is empty
    std::int32_t phases_left[lanes];       // phases of this call that the instance has before it, this one included

    /// Lanes that hold a running instance, inside the loop, which one lane alone only enters with one.
    MYRIAD_FUNCTION mask running() const {
        if constexpr (lanes == 1) {
            return true;
        } else {
            return active;
        }
    }
    /// Time of the committed state.
    MYRIAD_FUNCTION S now() const {
        if constexpr (is_adaptive<Method>) {
            return data.t;
        } else {
            return fma(S(done), step, base);
        }
    }

    /// f at the committed state, in the lanes where it is not known.
    MYRIAD_FUNCTION void renew_slope(const mask& lanes) {
        const mask needed = lanes & !slope_valid;
        if (!any(needed)) return;
        const auto fresh = evaluate_rhs<Model>(now(), data.y, data);
        MYRIAD_UNROLL
        for (int c = 0; c < n; ++c) slope[c] = select(needed, fresh[c], slope[c]);
        extra_evaluations = count_where(needed, extra_evaluations);
        slope_valid = slope_valid | needed;
    }
    /// The same in every lane, of a method that computes its first slope itself: where it is known, it has the same bits.
    MYRIAD_FUNCTION void renew_slopes() {
        const mask needed = !slope_valid;
        if (!any(needed)) return;
        slope = evaluate_rhs<Model>(now(), data.y, data);
        extra_evaluations = count_where(needed, extra_evaluations);
        slope_valid = mask(true);
    }

    /// Keeps a step that a hook or an earlier call left within the options' limits.
    MYRIAD_FUNCTION void bound_step(const kernel_arguments<Model, R>& args, int i) {
        const R wanted = get_lane(data.h_next, i);
        set_lane(data.h_next, i, copysign(min(max(abs(wanted), args.minimum_step), args.maximum_step), wanted));
    }

    /// Ends the phase of lane i with the given status; a failure stands.
    MYRIAD_FUNCTION void end_lane(int i, myriad::status why) {
        if (!is_failure(ending[i])) ending[i] = why;
        set_lane(ended, i, true);
    }
    /// Ends the phase of every lane of the mask.
    MYRIAD_FUNCTION void end_lanes(const mask& which, myriad::status why) {
        for_each_lane(which, [&](int i) MYRIAD_LAMBDA { end_lane(i, why); });
    }
};

}  // namespace myriad::inline MYRIAD_TARGET
