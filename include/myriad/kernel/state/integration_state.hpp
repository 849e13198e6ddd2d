// SPDX-License-Identifier: MIT
// The state of one running pack of lanes, shared by the parts of the loop: the instances' data and the loop's own
// variables.
#pragma once

#include <cstdint>
#include <type_traits>
#include <utility>

#include "myriad/kernel/scalar/lanes.hpp"
#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/state/breaking_state.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"
#include "myriad/kernel/state/slope_cache.hpp"
#include "myriad/kernel/state/stepping_state.hpp"
#include "myriad/kernel/state/stop_state.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Whether the rounding error of t is stored beside t, so that it does not accumulate: where steps are too short for
/// the resolution of t, as in single precision and to events. Other steps are rounded to that resolution.
template <class Model, class Method, class R>
inline constexpr bool keeps_time_low = has_events<Model> ||
                                       (is_adaptive<Method> ? std::is_same_v<R, float>
                                                            : writes_time_domain<Model> || has_known_stops<Model>);

/// A step of so many times |t| at least is one that t resolves, however it is rounded and shortened a little.
template <class R>
inline constexpr R resolved_roundings = R(16) * epsilon_of<R>;

template <class Model, class Method, class S>
struct integration_state {
    using R = real_of<S>;
    using mask = mask_of<S>;
    using count = count_of<S>;
    static constexpr int lanes = lanes_of<S>;
    // A single instance counts iterations from the start of each phase, in one register, up to zero: so that the check
    // for the last one needs no other number.
    using iteration_number = std::conditional_t<lanes == 1, std::int32_t, std::int64_t>;
    static constexpr auto n = n_state<Model>;

    lane_data<Model, S> data;
    mask active;  // lanes that hold an instance
    slope_cache<Model, Method, S> slopes;

    // the trial step
    S h;              // its length, signed
    mask final_step;  // it ends at t_stop()

    stepping_state<Method, S> steps;  // of the method's `stepping`, which owns it
    stop_state<Model, S> stops;       // of `stop_driver`, which owns them
    breaking_state<Model, S> breaks;  // of `breaking_points`, which owns them

    // lanes whose phase ends in this iteration of the loop, and how
    mask ended;
    myriad::status ending[lanes];
    bool instance_over[lanes];

    // work, per instance
    iteration_number iteration;   // iterations of the loop; every active lane takes a trial step in each
    iteration_number next_check;  // iteration at which a phase of a pack must be checked: too long, or stagnating
    iteration_number phase_start[lanes];  // iteration at which the lane's phase began
    std::int64_t all_iterations;          // iterations before `iteration` was last reset
    count rejected, located, extra_evaluations;
    std::int64_t instance[lanes];     // index, or -1: the lane is empty
    std::int32_t phases_left[lanes];  // phases of this call still to do, this one included

    /// Lanes that hold a running instance, inside the loop. With one lane, the loop is only entered with an instance.
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
            return steps.time();
        }
    }

    /// The time that no step passes: the next stop time, or t_end.
    MYRIAD_FUNCTION const S& t_stop() const {
        if constexpr (has_known_stops<Model>) {
            return stops.next;
        } else {
            return data.t_end;
        }
    }

    MYRIAD_FUNCTION void clear_iterations(const kernel_arguments<Model, R>& args) {
        iteration = lanes == 1 ? -args.max_steps : 0;
        next_check = 0;
        all_iterations = 0;
    }
    /// The phase of lane i begins.
    MYRIAD_FUNCTION void begin_iterations(const kernel_arguments<Model, R>& args, int i) {
        if constexpr (lanes == 1) {
            all_iterations = all_iterations_of(args);
            iteration = -args.max_steps;
        } else {
            phase_start[i] = iteration;
        }
    }
    /// Iterations in which the phase of lane i has taken a trial step.
    MYRIAD_FUNCTION iteration_number iterations_of(const kernel_arguments<Model, R>& args, int i) const {
        return lanes == 1 ? iteration + args.max_steps : iteration - phase_start[i];
    }
    /// Iterations of all phases of the pack.
    MYRIAD_FUNCTION std::int64_t all_iterations_of(const kernel_arguments<Model, R>& args) const {
        return all_iterations + (lanes == 1 ? iteration + args.max_steps : iteration);
    }

    /// The slope at the committed state of lane i, for inspection.
    MYRIAD_FUNCTION vec<R, n> slope_of(int i) { return slopes.of_lane(i, now(), data, extra_evaluations); }

    /// Limits a step set by a hook or an earlier call to the options' bounds.
    MYRIAD_FUNCTION void bound_step(const kernel_arguments<Model, R>& args, int i) {
        const R wanted = get_lane(data.h_next, i);
        set_lane(data.h_next, i, copysign(min(max(abs(wanted), args.minimum_step), args.maximum_step), wanted));
    }

    // A part of the loop that decides how the phase of a lane ends returns that, and `success` if it goes on; or calls
    // a function `end` of the loop's, where a value would cost registers in every step. Only the loop, and what calls
    // hooks one after the other, end phases.

    /// Ends the phase of lane i for a reason other than `success`; an earlier failure stands.
    MYRIAD_FUNCTION void end_lane(int i, myriad::status why) {
        if (why == myriad::status::success) return;
        if (!is_failure(ending[i])) ending[i] = why;
        set_lane(ended, i, true);
    }
    /// The same for every lane of the mask.
    MYRIAD_FUNCTION void end_lanes(const mask& which, myriad::status why) {
        for_each_lane(which, [&](int i) MYRIAD_LAMBDA { end_lane(i, why); });
    }
    /// Carries out what a hook of lane i wants.
    MYRIAD_FUNCTION void carry_out(int i, action wanted) {
        if (wanted == action::proceed) return;
        myriad::status why = myriad::status::stopped_by_user;
        if constexpr (has_stops<Model>) {
            if (wanted == action::overflow) why = myriad::status::queue_overflow;
        }
        end_lane(i, why);
        if (wanted == action::end_instance) instance_over[i] = true;
    }

    /// Takes the step size set by a hook. NaN is refused, as `not_finite`: the lane keeps its old step size.
    [[nodiscard]] MYRIAD_FUNCTION myriad::status take_step_size(const kernel_arguments<Model, R>& args, int i,
                                                                R before) {
        if (get_lane(data.h_next, i) == get_lane(data.h_next, i)) {
            bound_step(args, i);
            return myriad::status::success;
        }
        set_lane(data.h_next, i, before);
        return myriad::status::not_finite;
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
