// SPDX-License-Identifier: MIT
// Locates events where rounding may decide: functions on their surface, at jumps, several at once, without a tolerance,
// checked at points inside the step, or at t_end or a stop.
#pragma once

#include "myriad/kernel/event/event_location.hpp"
#include "myriad/kernel/event/side_resolver.hpp"
#include "myriad/kernel/event/step_scan.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The general way to locate events in one lane, for any trial, with the rounding errors of the event functions.
template <class Model, class Method, class S>
struct general_locator {
    using R = real_of<S>;
    static constexpr auto m = n_event<Model>;
    using reals = vec<R, m>;  // of the event functions in one lane
    using flags = mask_set<bool, m>;
    using ends_of_step = step_ends<Model, R>;
    using fired = fired_events<Model, S>;
    using location = event_location<Model, Method, S>;
    using resolver = side_resolver<Model, Method, S>;

    lane_sides<Model, Method, S> sides;

    MYRIAD_FUNCTION trial_outcome locate(int i, ends_of_step& step, const trial_ends<Model, S>& ends,
                                         fired& events) const {
        auto& own = sides.memory_of(i);
        auto& near = own.near;
        step.g = detail::evaluate_events<Model>(step.t, step.y, step.p);
        near.roundings = step.roundings(&sides.scratch().place);
        resolver{sides}.resolve_open_sides(i, step, near.roundings);
        const bool locating = sides.is_locating(i), seeking = locating && own.redo.target != own.redo.none;
        reals& side = sides.scratch().side;
        flags crossed;
        crossed.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            side[j] = sides.side_of(j, i);
            // A function that has not been on its side since its event has not crossed from there while it comes
            // nearer.
            const R start = own.on_jump[j] ? R(0) : max(R(0), -side[j] * step.g[j]);
            const R tolerance = max(start, seeking ? own.redo.tolerance[j] : sides.args.event[j].tolerance);
            const bool located = seeking && (own.redo.target == j || own.redo.crossed[j]);
            near.bands[j] = max(tolerance, near.roundings[j]);
            near.allowances[j] = located ? tolerance : start;
            const bool signs_tell =
                seeking && own.redo.target == j && !own.redo.narrow && own.redo.goes_by_signs(j, near.roundings[j]);
            const R past = signs_tell ? near.allowances[j] : near.past(j);
            crossed.set(j, sides.crosses(j, side[j], step.g1[j], past) && !sides.is_at_jump(j, i, step.h));
        }
        auto& part = sides.scratch().part;
        part = step_part<R>{};
        if (MYRIAD_UNLIKELY(sides.args.sub_samples > 1)) {
            location{sides}.evaluate_end_slope(i, step, ends);
            part.scanned = true;
            crossed = step_scan<Model, Method, S>{sides}.run(i, step, side, part);
            if (part.turn != R(0)) {
                own.redo.begin_turn(part.turn * step.h, locating ? own.redo.resume : get_lane(sides.s.data.h_next, i));
                location{sides}.redo_step(i);
                return trial_outcome::is_redone;
            }
        }
        const bool is_last = get_lane(sides.s.final_step, i) && ends_near_root(i, step);
        arrival reached{};
        if (seeking) {
            reached = arrival_of(i, step, side);
            // At a root in the other direction, to which a long step has come, the event's is anywhere beyond.
            MYRIAD_UNROLL
            for (int j = 0; j < MYRIAD_LENGTH(m); ++j)
                if (part.scanned && own.redo.target == j && !sides.is_asked(j, side[j])) reached.gap = infinity_of<R>;
        }
        if (!part.scanned && (crossed.any_of() || (seeking ? !reached.is_plain() : is_last)))
            location{sides}.evaluate_end_slope(i, step, ends);
        if (crossed.any_of()) {
            evaluate_start(i, step, side);
            location{sides}.begin_or_shorten(i, step, side, crossed, part, near, events);
            return trial_outcome::is_redone;
        }
        if (seeking) {
            if (arrive(i, step, side, reached, events) == trial_outcome::is_redone) return trial_outcome::is_redone;
        } else if (locating) {
            location{sides}.end(i);
        } else if (is_last) {
            end_on_root(i, step, side, events);
        }
        resolver{sides}.update_after_trial(i, step, side);
        sides.update_in_question(i);
        return trial_outcome::stands;
    }

private:
    /// Whether an event may happen at t_end or a stop.
    MYRIAD_FUNCTION bool ends_near_root(int i, const ends_of_step& step) const {
        const auto& near = sides.memory_of(i).near;
        bool any_near = false;
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            const bool given = sides.args.event[j].tolerance > R(0);
            const R close = given ? near.band(j) : max(near.band(j), R(last_part) * abs(step.g[j] - step.g1[j]));
            any_near = any_near || abs(step.g1[j]) <= close;
        }
        return any_near;
    }
    /// A function whose value at the end is a larger part of its change in the last step has no event there.
    static constexpr double last_part = 1.0 / 64;

    /// Evaluates the event functions at the start of the step. A function at a jump that no step has passed yet counts
    /// as infinite.
    MYRIAD_FUNCTION void evaluate_start(int i, ends_of_step& step, const reals& side) const {
        step.g = detail::evaluate_events<Model>(step.t, step.y, step.p);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j)
            if (sides.memory_of(i).on_jump[j]) step.g[j] = copysign(R(infinity_of<R>), side[j]);
    }
    /// How near to its event a redone step that did not cross has ended.
    struct arrival {
        R gap, band, close;  // of the event's function: its value, within which it fires, and needs no better guess
        bool others;         // other functions crossed in the trial before
        bool all_left;       // every function has left the surface since its event last fired

        /// A better guess is not worth another trial.
        MYRIAD_FUNCTION bool is_close() const { return abs(gap) <= close; }
        /// Only the event itself happens here.
        MYRIAD_FUNCTION bool is_plain() const { return is_close() && !others && all_left; }
    };
    MYRIAD_FUNCTION arrival arrival_of(int i, const ends_of_step& step, const reals& side) const {
        const auto& redo = sides.memory_of(i).redo;
        const auto& near = sides.memory_of(i).near;
        arrival reached{R(0), R(0), R(0), false, true};
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            reached.all_left = reached.all_left && sides.e.left.get(j, i);
            if (redo.target == j) {
                reached.gap = side[j] * step.g1[j];
                if (redo.goes_by_signs(j, near.rounding(j))) continue;
                reached.band = near.band(j);
                reached.close = max(R(arrival_part) * redo.tolerance[j], R(0.125) * near.rounding(j));
            } else {
                reached.others = reached.others || redo.crossed[j];
            }
        }
        return reached;
    }

    /// Handles a redone step that ended before its crossing: close to it its events fire; else it is lengthened. Other
    /// functions that crossed in a trial before fire along if their crossings cannot be told from this one: they go to
    /// their other side, and are there as `look_around` finds; or they have another sign at the end of a bracket whose
    /// ends are one, up to rounding.
    MYRIAD_FUNCTION trial_outcome arrive(int i, const ends_of_step& step, const reals& side, const arrival& reached,
                                         fired& events) const {
        auto& e = sides.e;
        auto& own = sides.memory_of(i);
        auto& redo = own.redo;
        const auto& near = own.near;
        const bool narrow = redo.is_between(step.h);
        auto& found = sides.scratch();
        reals &slope = found.slope, &heading = found.heading, &middle = found.middle;
        flags& here = found.crosses;
        slope = heading = middle = step.g1;
        here.clear();
        if (!reached.is_plain()) {
            detail::look_around(&found, &own, false);
            detail::find_headings_without_slope(&found);
            if (!reached.all_left) middle = step.values_at(R(0.5));
        }
        R approach = R(0);
        // It leaves the surface where it fired last, so that its crossing is later, however near it is to zero, and
        // maybe still past it.
        bool leaves = false;
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            if (redo.target != j) continue;
            approach = side[j] * slope[j];
            leaves = !reached.all_left && !e.left.get(j, i) && side[j] * heading[j] > R(0);
        }
        if (!reached.is_close() || leaves) {
            const R guess = leaves ? step.h : step.h - reached.gap * reciprocal(approach);
            const bool short_of_it = reached.gap > reached.band || leaves;
            bool further = short_of_it && !narrow && redo.tries < redo.most_trials;
            if (further) {
                redo.lengthen(step.h, guess);
            } else {
                further = abs(reached.gap) <= reached.band && redo.improve(step.h, guess, reached.gap > R(0));
            }
            if (further) {
                // The bracket may end here now, where it is not known which others have crossed.
                if (!(reached.gap > R(0))) redo.changed.clear();
                location{sides}.redo_step(i);
                return trial_outcome::is_redone;
            }
        }
        const bool timeless = sides.is_timeless(i, step.h);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            const R band = near.band(j);
            const bool heads = here[j] && side[j] * heading[j] < R(0);
            const bool between = narrow && redo.changed[j];
            const bool happens = redo.target == j || (redo.crossed[j] && (heads || between));
            events.put(j, i, happens, step.g1[j]);
            if (!reached.all_left && !timeless && !own.on_jump[j] && abs(middle[j]) > band) e.left.set(j, i, true);
            own.at_jump.set(j, happens && abs(step.g1[j]) > band && !(reached.others && here[j]));
        }
        location{sides}.end(i);
        return trial_outcome::stands;
    }

    /// Events at t_end or a stop: a function fires if it is at zero or past it, or reaches zero within the rounding of
    /// the time of that end, and if the first sign that it shows beyond is that of its other side. One that comes to
    /// rest at zero or turns back there, as at a double root, does not, nor does one that only approaches zero.
    MYRIAD_FUNCTION void end_on_root(int i, const ends_of_step& step, const reals& side, fired& events) const {
        auto& own = sides.memory_of(i);
        auto& found = sides.scratch();
        detail::begin_beyond(&found, &own, step_rounding(i, step), sides.s.iterations_of(sides.args, i));
        detail::find_first_signs(&found.place);
        own.at_jump.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            const bool reaches = side[j] * step.g1[j] <= R(0) || side[j] * found.heading[j] <= R(0);
            const bool close = abs(step.g1[j]) <= sides.args.event[j].end_tolerance;
            const bool happens = reaches && close && sides.is_asked(j, side[j]) && side[j] * found.place.sign[j] < R(0);
            events.put(j, i, happens, step.g1[j]);
            own.at_jump.set(j, happens && abs(step.g1[j]) > own.near.band(j));
        }
    }

    /// A bound on the time by which the rounding errors of a step may have moved a crossing at t_end or a stop.
    MYRIAD_FUNCTION R step_rounding(int i, const ends_of_step& step) const {
        const auto& args = sides.args;
        const R t_begin = args.t_begin != nullptr ? args.t_begin[sides.s.instance[i]] : args.common_t_begin;
        return R(2) * epsilon_of<R> * max(abs(step.t1), abs(t_begin));
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
