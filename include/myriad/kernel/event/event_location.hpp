// SPDX-License-Identifier: MIT
// The location of an event in one lane: its trial step as location sees it, the set-up of a redone step, and its end.
#pragma once

#include "myriad/kernel/controller/stepping.hpp"
#include "myriad/kernel/event/earliest_crossing.hpp"
#include "myriad/kernel/event/event_nearness.hpp"
#include "myriad/kernel/event/fired_events.hpp"
#include "myriad/kernel/event/lane_sides.hpp"
#include "myriad/kernel/event/side_resolver.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// What happens to an accepted trial: it is redone; or it stands, and the sides of the event functions are up to date,
/// or still those at its start.
enum class trial_outcome { is_redone, stands, stands_before_sides };

/// The ends of a trial, in all lanes.
template <class Model, class S>
struct trial_ends {
    S t1;
    vec<S, n_state<Model>> y, slope_start, slope_end;  // slope_end only for methods that compute it
    vec<S, n_event<Model>> g;
};

/// What both ways to locate events share.
template <class Model, class Method, class S>
struct event_location {
    using R = real_of<S>;
    static constexpr auto m = n_event<Model>;
    using reals = vec<R, m>;  // of the event functions in one lane
    using flags = mask_set<bool, m>;
    using fired = fired_events<Model, S>;

    lane_sides<Model, Method, S> sides;

    MYRIAD_FUNCTION void evaluate_end_slope(int i, step_ends<Model, R>& step, const trial_ends<Model, S>& ends) const {
        if constexpr (Method::first_same_as_last) {
            step.slope1 = get_lanes<R>(ends.slope_end, i);
        } else {
            step.slope1 = detail::evaluate_rhs<Model>(step.t1, step.y1, step.p);
            add_to_count(sides.s.extra_evaluations, i);
        }
    }

    /// Sets up a lane whose trial crossed: either a redone step, or an event at the start of the step.
    template <class Nearness>
    MYRIAD_FUNCTION void begin_or_shorten(int i, const step_ends<Model, R>& step, const reals& side,
                                          const flags& crossed, const step_part<R>& part, const Nearness& near,
                                          fired& events) const {
        const auto& args = sides.args;
        auto& s = sides.s;
        auto& own = sides.memory_of(i);
        auto& redo = own.redo;
        const bool again = sides.is_locating(i) && redo.target != redo.none;
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            bool may_cross = again && redo.crossed[j];
            if constexpr (!Nearness::is_plain)  // near the end of the first trial, or beyond it
                may_cross =
                    may_cross || (!again && sides.is_asked(j, side[j]) && abs(step.g1[j]) <= R(64) * near.rounding(j));
            redo.crossed.set(j, crossed[j] || may_cross);
            redo.changed.set(j, redo.crossed[j] && side[j] * step.g1[j] < R(0));
            if (again) continue;
            const R change = abs(step.g1[j] - step.g[j]);
            redo.tolerance[j] = min(args.event[j].tolerance, R(largest_part) * change);
        }
        located_crossing<R> first;
        if (MYRIAD_UNLIKELY(part.scanned && (!again || part.high < R(1)))) {
            first = detail::earliest_crossing_between(part.low, part.high, step, crossed);
        } else if constexpr (Nearness::is_plain) {
            first = detail::only_crossing(step, side, crossed, sides.e.left.of_lane(i), redo.tolerance);
        } else {
            first = detail::earliest_crossing(step, side, crossed, sides.e.left.of_lane(i), redo.tolerance);
        }
        redo.target = first.event;
        const R guess = step.h * first.fraction;
        if (again) {
            redo.shorten(step.h, guess);
        } else {
            redo.begin(step.h, guess, sides.is_locating(i) ? redo.resume : get_lane(s.data.h_next, i));
        }
        if (redo.length != R(0)) return redo_step(i);
        add_to_count(s.located, i);
        stop_locating(i);
        auto& scratch = sides.scratch();
        const reals rounding = near.roundings_at_start(step, &scratch.place);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j)
            own.at_jump.set(j, !(side[j] * step.g[j] <= max(redo.tolerance[j], rounding[j])));
        scratch.crosses.clear();
        if constexpr (!Nearness::is_plain) {
            if (!again) {
                detail::look_around(&scratch, &own, true);
                detail::find_headings_without_slope(&scratch);
            }
        }
        // Others whose crossing cannot be told from this one, as where a redone step arrives; or those that lie with it
        // between the start and the shortest trial beyond it.
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            const bool along = scratch.crosses[j] && side[j] * scratch.heading[j] < R(0);
            const bool happens = redo.target == j || (again ? redo.changed[j] : along);
            events.put(j, i, happens, step.g[j]);
            own.at_jump.set(j, happens && own.at_jump[j] && !scratch.crosses[j]);
        }
        stepping<Model, Method, S>{args, s}.resume(i, redo.resume);
    }

    /// The next trial has the length that `redo` says.
    MYRIAD_FUNCTION void redo_step(int i) const {
        add_to_count(sides.s.located, i);
        set_lane(sides.s.data.h_next, i, sides.memory_of(i).redo.length);
        sides.e.flags.set(sides.e.locating, i, true);
        sides.e.flags.set(sides.e.in_question, i, true);
    }
    /// The event to which the step was redone is reached.
    MYRIAD_FUNCTION void end(int i) const {
        stop_locating(i);
        stepping<Model, Method, S>{sides.args, sides.s}.resume(i, sides.memory_of(i).redo.resume);
    }
    /// A redone step that failed its error test is not redone: the controller sets the length of the next.
    MYRIAD_FUNCTION void stop_locating(int i) const {
        sides.e.flags.set(sides.e.locating, i, false);
        sides.update_in_question(i);
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
