// SPDX-License-Identifier: MIT
// Locates events where rounding may decide: functions on their surface, at jumps, several at once, without a tolerance,
// checked at points inside the step, or at t_end or a stop.
#pragma once

#include "myriad/kernel/event/event_location.hpp"
#include "myriad/kernel/event/side_resolver.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The general way to locate events in one lane, for any trial, with the rounding errors of the event functions.
template <class Model, class Method, class S>
struct general_locator {
    using R = real_of<S>;
    static constexpr int m = n_event<Model>;
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
        near.roundings = step.roundings();
        resolver{sides}.resolve_open_sides(i, step, near.roundings);
        const bool locating = sides.is_locating(i);
        reals side;
        flags crossed;
        crossed.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            side[j] = sides.side_of(j, i);
            // Only as far as it was on the other side at the start may a function be there without having crossed.
            const R start = own.on_jump[j] ? R(0) : -side[j] * step.g[j];
            const R tolerance = locating ? own.redo.tolerance[j] : sides.args.event[j].tolerance;
            near.floors[j] = max(near.roundings[j], start);
            near.bands[j] = max(tolerance, near.floors[j]);
            const bool located = locating && (own.redo.target == j || own.redo.crossed[j]);
            near.pasts[j] = located ? near.bands[j] : near.floors[j];
            crossed.set(j, sides.crosses(j, side[j], step.g1[j], near.past(j)) && !sides.is_at_jump(j, i, step.h));
        }
        step_part<R> part;
        if (MYRIAD_UNLIKELY(sides.args.sub_samples > 1)) {
            location{sides}.evaluate_end_slope(i, step, ends);
            part.scanned = true;
            crossed = scan(i, step, side, part);
        }
        const bool is_last = get_lane(sides.s.final_step, i) && ends_near_root(i, step);
        arrival reached{};
        if (locating) {
            reached = arrival_of(i, step, side);
            // At a root in the other direction, to which a long step has come, the event's is anywhere beyond.
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j)
                if (part.scanned && own.redo.target == j && !sides.is_asked(j, side[j])) reached.gap = infinity_of<R>;
        }
        if (!part.scanned && (crossed.any_of() || (locating ? !reached.is_plain() : is_last)))
            location{sides}.evaluate_end_slope(i, step, ends);
        if (crossed.any_of()) {
            evaluate_start(i, step, side);
            location{sides}.begin_or_shorten(i, step, side, crossed, part, near, events);
            return trial_outcome::is_redone;
        }
        if (locating) {
            if (arrive(i, step, side, reached, events) == trial_outcome::is_redone) return trial_outcome::is_redone;
        } else if (is_last) {
            evaluate_start(i, step, side);
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
        for (int j = 0; j < m; ++j) {
            const bool given = sides.args.event[j].tolerance > R(0);
            const R close = given ? near.band(j) : max(near.band(j), R(last_part) * abs(step.g[j] - step.g1[j]));
            any_near = any_near || abs(step.g1[j]) <= close;
        }
        return any_near;
    }
    /// The part of the last step beyond which rounding could not be told from a slow approach.
    static constexpr double last_part = 1.0 / 64;

    /// Evaluates the event functions at the start of the step. A function at a jump that no step has passed yet counts
    /// as infinite.
    MYRIAD_FUNCTION void evaluate_start(int i, ends_of_step& step, const reals& side) const {
        step.g = detail::evaluate_events<Model>(step.t, step.y, step.p);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j)
            if (sides.memory_of(i).on_jump[j]) step.g[j] = copysign(R(infinity_of<R>), side[j]);
    }
    /// Checks `sub_samples` points of the step for the first crossing, updates the sides up to it, and sets `part` to
    /// the part of the step that contains it.
    MYRIAD_FUNCTION flags scan(int i, const ends_of_step& step, reals& side, step_part<R>& part) const {
        const auto& args = sides.args;
        const auto& near = sides.memory_of(i).near;
        auto& e = sides.e;
        flags crossed;
        crossed.clear();
        MYRIAD_ROLLED
        for (int k = 1; k <= args.sub_samples; ++k) {
            const bool last = k == args.sub_samples;
            const R theta = static_cast<R>(k) / static_cast<R>(args.sub_samples), length = theta * step.h;
            const reals g = last ? step.g1 : step.values_at(theta);
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j)
                crossed.set(j, sides.crosses(j, side[j], g[j], near.past(j)) && !sides.is_at_jump(j, i, length));
            if (crossed.any_of()) {
                part.high = theta;
                break;
            }
            if (!last) part.low = theta;
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j) {
                if (!(abs(g[j]) > near.past(j)) || sides.is_at_jump(j, i, length)) continue;
                side[j] = sign_of(g[j]);
                if (!sides.is_timeless(i, length) && !sides.memory_of(i).on_jump[j]) e.left.set(j, i, true);
            }
        }
        return crossed;
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
        for (int j = 0; j < m; ++j) {
            reached.all_left = reached.all_left && sides.e.left.get(j, i);
            if (redo.target == j) {
                reached.gap = side[j] * step.g1[j];
                reached.band = near.band(j);
                reached.close = max(R(arrival_part) * redo.tolerance[j], R(0.5) * near.rounding(j));
            } else {
                reached.others = reached.others || redo.crossed[j];
            }
        }
        return reached;
    }

    /// Handles a redone step that ended before its crossing: close to it its events fire; else it is lengthened.
    MYRIAD_FUNCTION trial_outcome arrive(int i, const ends_of_step& step, const reals& side, const arrival& reached,
                                         fired& events) const {
        auto& e = sides.e;
        auto& own = sides.memory_of(i);
        auto& redo = own.redo;
        const auto& near = own.near;
        const bool narrow = redo.is_between(step.h);
        reals slope = step.g1, middle = step.g1;
        if (!reached.is_plain()) {
            slope = step.slopes1();
            if (!reached.all_left) middle = step.values_at(R(0.5));
        }
        if (!reached.is_close()) {
            R approach = R(0);
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j)
                if (redo.target == j) approach = side[j] * slope[j];
            const R guess = step.h - reached.gap * reciprocal(approach);
            const bool short_of_it = reached.gap > reached.band;
            bool further = short_of_it && !narrow && redo.tries < redo.most_trials;
            if (further) {
                redo.lengthen(step.h, guess);
            } else {
                further = abs(reached.gap) <= reached.band && redo.improve(step.h, guess, reached.gap > R(0));
            }
            if (further) {
                location{sides}.redo_step(i);
                return trial_outcome::is_redone;
            }
        }
        const bool timeless = sides.is_timeless(i, step.h);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const R band = near.band(j);
            const bool heads = abs(step.g1[j]) <= band && side[j] * slope[j] * step.h < R(0);
            const bool jumps = narrow && side[j] * step.g1[j] > band;
            const bool happens = redo.target == j || (redo.crossed[j] && (heads || jumps));
            events.put(j, i, happens, step.g1[j]);
            if (!reached.all_left && !timeless && !own.on_jump[j] && abs(middle[j]) > band) e.left.set(j, i, true);
            own.at_jump.set(j, happens && abs(step.g1[j]) > band);
        }
        location{sides}.end(i);
        return trial_outcome::stands;
    }

    /// Events at t_end or a stop: a function moving towards zero fires if it is at or past zero, or short of it
    /// by rounding alone, judged by both its slope and the last step. A function that comes to rest at zero, or is
    /// still falling towards it, gets there later or never; one that is about to turn back, as at a double root, does
    /// not cross it.
    MYRIAD_FUNCTION void end_on_root(int i, const ends_of_step& step, const reals& side, fired& events) const {
        auto& own = sides.memory_of(i);
        const reals slope = step.slopes1();
        const R rounding = end_rounding(i, step);
        own.at_jump.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const R g = side[j] * step.g1[j], speed = -side[j] * slope[j] * sign_of(step.h);  // towards zero
            const R last_speed = (side[j] * step.g[j] - g) / abs(step.h);
            const bool at_zero = g <= R(0) || g <= (speed < last_speed ? speed : last_speed) * rounding;
            const bool close = abs(g) <= sides.args.event[j].end_tolerance;
            // The discriminant of the parabola through the last step's start, with the slope at its end.
            const R bend = (last_speed - speed) / abs(step.h);
            const bool turns = speed * speed <= R(8) * bend * (abs(g) + own.near.rounding(j));
            events.put(j, i, sides.is_asked(j, side[j]) && close && speed > R(0) && at_zero && !turns, step.g1[j]);
        }
    }

    /// A bound on the time between t_end or a stop and a crossing that the phase's rounding errors may have
    /// caused; capped at a small part of a step, beyond which it could not be told from a slow approach.
    MYRIAD_FUNCTION R end_rounding(int i, const ends_of_step& step) const {
        const auto& args = sides.args;
        const auto& s = sides.s;
        const R t_begin = args.t_begin != nullptr ? args.t_begin[s.instance[i]] : args.common_t_begin;
        const R steps = static_cast<R>(s.iterations_of(args, i));
        const R rounding = R(2) * epsilon_of<R> * steps * max(abs(step.t1), abs(t_begin));
        return min(rounding, R(last_part) * abs(step.h));
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
