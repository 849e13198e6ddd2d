// SPDX-License-Identifier: MIT
// Resolves the side of event functions whose sign does not tell it: on their surface up to rounding, right after their
// event, before a jump, or moved by a hook or the host. Rounding errors, slopes and values a little ahead decide.
#pragma once

#include <cstdint>

#include "myriad/kernel/event/fired_events.hpp"
#include "myriad/kernel/event/lane_sides.hpp"
#include "myriad/kernel/event/step_ends.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class S>
struct side_resolver {
    using R = real_of<S>;
    static constexpr auto n = n_state<Model>;
    static constexpr auto m = n_event<Model>;
    using reals = vec<R, m>;  // of the event functions in one lane
    using flags = mask_set<bool, m>;
    using state = vec<R, n>;
    using fired = fired_events<Model, S>;

    lane_sides<Model, Method, S> sides;

    /// Starts a phase of lane i, in which the event functions have values g.
    MYRIAD_FUNCTION void begin(int i, const reals& g) const {
        const auto& args = sides.args;
        auto& e = sides.e;
        auto& own = sides.memory_of(i);
        bool undefined = false;
        flags at_jump, in_question;
        at_jump.clear();
        in_question.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            const bool fired_there = kept_event(sides.kept_at(j, i)).kind() == kept_side::fired;
            in_question.set(j, !(fired_there && args.event[j].tolerance > R(0)));
        }
        const reals rounding = sides.roundings_if_needed(i, g, in_question);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            const kept_event kept(sides.kept_at(j, i));
            const kept_side kind = kept.kind();
            const bool has_fired = kind == kept_side::fired, keeps = has_fired || kind == kept_side::within;
            const R tolerance = max(args.event[j].tolerance, rounding[j]);
            // An event is located only as closely as t resolves, and t may have started anew since.
            const R band = has_fired ? max(tolerance, kept.template value_bound<R>()) : keeps ? tolerance : rounding[j];
            const bool beyond = abs(g[j]) > band;
            undefined = undefined || g[j] != g[j];
            at_jump.set(j, beyond && kind == kept_side::on_jump);
            // Flights that accumulate may do so over many phases that another event ends.
            own.lingered[j] = abs(g[j]) > tolerance ? 0 : kept.lingered();
            e.left.set(j, i, own.lingered[j] == 0);
            sides.put_side(j, i, beyond ? sign_of(g[j]) : R(0));
            own.fired_last.set(j, has_fired);
            if (keeps && !beyond) {
                e.above.set(j, i, kept.above());
                own.open.set(j, true);
                own.held.set(j, true);
            }
        }
        e.flags.set(e.undefined, i, undefined);
        if (at_jump.any_of()) take_sides_ahead(i, at_jump, g, sides.s.slope_of(i));
        sides.update_in_question(i);
    }

    /// Stores the sides of lane i, in which the event functions have values g, for its next phase.
    MYRIAD_FUNCTION void store(int i, const reals& g) const {
        const auto& e = sides.e;
        const auto& own = sides.memory_of(i);
        flags in_question;
        in_question.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) in_question.set(j, !sides.is_fresh(j, i));
        const reals rounding = sides.roundings_if_needed(i, g, in_question);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            const R side = sides.side_of(j, i);
            kept_side kept = side * g[j] > rounding[j] ? kept_side::beyond : kept_side::within;
            if (sides.is_fresh(j, i)) kept = kept_side::fired;
            if (!e.left.get(j, i) && own.on_jump[j]) kept = kept_side::on_jump;
            if (side == R(0)) kept = kept_side::unknown;
            const kept_event all(side > R(0), kept, e.left.get(j, i) ? 0 : own.lingered[j]);
            sides.kept_at(j, i) = (kept == kept_side::fired ? all.at_value(g[j]) : all).code();
        }
    }

    /// Sets open sides to where the functions, on the surface at the start of the step, are heading. The side that a
    /// phase has kept for one there stands, unless its event fired there: then the host may have turned the flow round,
    /// which shows in a slope that is not rounding itself.
    MYRIAD_FUNCTION void resolve_open_sides(int i, const step_ends<Model, R>& step, const reals& rounding) const {
        const auto& own = sides.memory_of(i);
        const flags open = own.open, held = own.held, fired_last = own.fired_last;
        if (!open.any_of()) return;
        const reals slope = step.slopes();
        const reals heading = headings(slope, open, step.t, step.y, step.slope, step.h, step.p, &sides.scratch().place);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            if (!open[j]) continue;
            const bool turns = fired_last[j] && abs(slope[j] * step.h) > rounding[j];
            sides.put_side(j, i, held[j] && !turns ? (sides.e.above.get(j, i) ? R(1) : R(-1)) : heading[j]);
        }
    }

    /// Updates the sides at the end of an accepted trial; `side` holds those before it. A function within its `band`
    /// has not left the surface.
    MYRIAD_FUNCTION void update_after_trial(int i, const step_ends<Model, R>& step, const reals& side) const {
        const bool timeless = sides.is_timeless(i, step.h);
        auto& e = sides.e;
        auto& own = sides.memory_of(i);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            if (sides.is_at_jump(j, i, step.h)) continue;  // after the trial it is still at the jump where it fired
            own.on_jump.set(j, false);
            own.fresh.set(j, false);
            sides.put_side(j, i, abs(step.g1[j]) > own.near.past(j) ? sign_of(step.g1[j]) : side[j]);
            e.left.set(j, i, e.left.get(j, i) || (abs(step.g1[j]) > own.near.band(j) && !timeless));
        }
    }

    /// Determines the sides after the actions of events; `found` is the data before them. A function that fired is on
    /// the side it is heading for. If its slope is zero, it stays on the side it came from if an action changed it, and
    /// has crossed if none did. If it was still moving away when it fired, as in a flight too short for the resolution
    /// of the state, an action that reversed it must not send it through the surface. A function with a jump fired
    /// right before the jump: its value a little ahead tells whether it is about to pass it. The same holds for one
    /// that fired at a jump earlier, as this action may have moved the state.
    MYRIAD_FUNCTION void update_after_events(int i, const fired& events, const lane_data<Model, S>& found) const {
        auto& s = sides.s;
        auto& e = sides.e;
        auto& on_jump = sides.memory_of(i).on_jump;
        reals slope_before;
        const reals before = headings_at_events(i, found, events, slope_before);
        reals g = get_lanes<R>(events.value, i), slope = slope_before, heading = before;
        bool known = !get_lane(events.changed, i);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) known = known && !on_jump[j] && !fires_at_jump(j, i, events);
        state along;  // the slope of the state, where it is needed
        if (!known) {
            along = s.slope_of(i);
            const auto& p = sides.inputs_of(i);
            const R t = get_lane(s.now(), i);
            const state y = get_lanes<R>(s.data.y, i);
            g = detail::evaluate_events<Model>(t, y, p);
            slope = detail::event_slopes<Model>(t, y, along, p);
            heading =
                headings(slope, events.which.of_lane(i), t, y, along, get_lane(s.h, i), p, &sides.scratch().place);
        }
        flags at_jump, in_question;
        at_jump.clear();
        in_question.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            const bool moved = g[j] != get_lane(events.value[j], i);
            in_question.set(j, moved || on_jump[j] || fires_at_jump(j, i, events));
        }
        const reals rounding = sides.roundings_if_needed(i, g, in_question);
        const R step = abs(sides.memory_of(i).redo.beyond);
        const R location_error = R(8) * (sides.rounding_of_time(i) + epsilon_of<R> * step);
        flags moved_near;
        moved_near.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            const bool others = !events.which.get(j, i) && !on_jump[j] && g[j] != get_lane(events.value[j], i);
            moved_near.set(j, others && detail::tells_heading(slope[j]) && abs(g[j]) <= abs(slope[j]) * location_error);
        }
        if (MYRIAD_UNLIKELY(moved_near.any_of())) {
            const R error = time_error(i, events, slope_before, location_error);
            MYRIAD_UNROLL
            for (int j = 0; j < MYRIAD_LENGTH(m); ++j)
                if (moved_near[j] && abs(g[j]) <= abs(slope[j]) * error) sides.put_side(j, i, heading[j]);
        }
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            const bool fires = events.which.get(j, i), waits = !fires && on_jump[j];
            const bool jumps = fires_at_jump(j, i, events);
            // An action that hardly moves its event's function leaves it on the surface: as closely as it was located,
            // or so near that it gets there in no more time than location may be wrong by. (Its rounding error there
            // does not tell: the states that it is made of were larger before.)
            const R located = min(R(2) * abs(get_lane(events.value[j], i)), sides.args.event[j].tolerance);
            const R residual = fires && !jumps ? max(located, abs(slope[j]) * location_error) : R(0);
            const bool beyond = abs(g[j]) > max(rounding[j], residual);
            if (g[j] != g[j]) e.flags.set(e.undefined, i, true);
            if (waits) {
                at_jump.set(j, beyond);
                on_jump.set(j, false);
                sides.put_side(j, i, beyond ? sign_of(g[j]) : R(0));
            } else if (fires) {
                const R from = sides.side_of(j, i), ahead = heading[j];
                const bool moved = g[j] != get_lane(events.value[j], i);
                const bool acted = moved || slope[j] != slope_before[j] || ahead != before[j];
                const bool unresolved = from * before[j] > R(0);
                const bool rests = ahead == R(0) && !e.left.get(j, i);
                at_jump.set(j, jumps && (moved || !unresolved) && beyond);
                R side = ahead;
                if (unresolved || ahead == R(0)) side = acted || rests ? from : -from;
                if (moved && beyond) side = sign_of(g[j]);
                on_jump.set(j, false);
                e.left.set(j, i, moved && beyond);
                sides.put_side(j, i, side);
            } else if (beyond) {
                e.left.set(j, i, e.left.get(j, i) || g[j] != get_lane(events.value[j], i));
            }
        }
        if (MYRIAD_UNLIKELY(!known && at_jump.any_of())) take_sides_ahead(i, at_jump, g, along);
        auto& own = sides.memory_of(i);
        ++own.moves;
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j)
            if (events.which.get(j, i) && in_question[j]) own.moved_at[j] = s.iterations_of(sides.args, i);
        sides.update_in_question(i);
    }

    /// The sides to which the event functions go from (t, y), in the direction of h: +1, -1, or 0 for those that rest.
    /// Their slopes tell; of functions in `wanted` without one, or with one that is not finite, the values ahead.
    static MYRIAD_FUNCTION reals headings(const reals& slope, const flags& wanted, const R& t, const state& y,
                                          const state& along, const R& h, const inputs<Model, R>& p,
                                          event_place<Model, R>* path) {
        reals heading;
        bool flat = false;
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            heading[j] = sign_of(slope[j]) * sign_of(h);
            flat = flat || (wanted[j] && !detail::tells_heading(slope[j]));
        }
        if (!MYRIAD_UNLIKELY(flat)) return heading;
        path->p = p;
        path->t = t, path->h = h, path->first = R(0);
        path->y = y, path->slope = along, path->bend = state{};
        detail::find_first_signs(path);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j)
            if (!detail::tells_heading(slope[j])) heading[j] = path->sign[j];
        return heading;
    }

private:
    MYRIAD_FUNCTION bool fires_at_jump(int j, int i, const fired& events) const {
        return events.which.get(j, i) && sides.memory_of(i).at_jump[j];
    }
    /// The same for events that fire in lane i, from the data `at`. A function right before a jump goes towards the
    /// jump if it is past it a little ahead.
    MYRIAD_FUNCTION reals headings_at_events(int i, const lane_data<Model, S>& at, const fired& events,
                                             reals& slope) const {
        auto& s = sides.s;
        const state along = s.slopes.of_lane(i, s.now(), at, s.extra_evaluations), y = get_lanes<R>(at.y, i);
        const auto& p = sides.inputs_of(i, at);
        const R t = get_lane(s.now(), i);
        flags jumps, smooth;
        jumps.clear();
        smooth.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            jumps.set(j, fires_at_jump(j, i, events));
            smooth.set(j, events.which.get(j, i) && !jumps[j]);
        }
        slope = detail::event_slopes<Model>(t, y, along, p);
        reals heading = headings(slope, smooth, t, y, along, get_lane(s.h, i), p, &sides.scratch().place);
        if (!jumps.any_of()) return heading;
        const reals g = values_ahead(i, at, along);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            if (!jumps[j]) continue;
            const R side = sides.side_of(j, i);
            heading[j] = g[j] * side > R(0) ? side : -side;
        }
        return heading;
    }

    /// By how much the time of the events that fired in lane i may be wrong, but no more than `most`: what their
    /// functions had to zero, and their rounding errors or tolerances. What an action moves onto a surface is beside it
    /// by so much.
    MYRIAD_FUNCTION R time_error(int i, const fired& events, const reals& slope, R most) const {
        const auto& near = sides.memory_of(i).near;
        R error = R(0);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            if (!events.which.get(j, i)) continue;
            const R tolerance = sides.args.event[j].tolerance;
            const R value =
                R(2) * abs(get_lane(events.value[j], i)) + (tolerance > R(0) ? tolerance : near.rounding(j));
            error = max(error, detail::tells_heading(slope[j]) ? value * reciprocal(abs(slope[j])) : most);
        }
        return min(error, most);
    }

    /// The number of roundings of t to the point ahead of a jump.
    static constexpr double roundings_ahead = 64;
    /// Of a time of so many roundings, until a state has moved by its own rounding.
    static constexpr int most_doublings = 64;
    /// A time longer than the rounding of t, and than the error of the last location at a jump.
    MYRIAD_FUNCTION R past_jump(int i) const {
        const R error = epsilon_of<R> * abs(get_lane(sides.s.now(), i)) + sides.memory_of(i).redo.error();
        return R(roundings_ahead) * error;
    }
    /// The event functions a little ahead, by the rounding of t and of the state: beyond a jump to which a step was
    /// located, if the state is heading for it. A longer time would pass the next event, too, of a state close to it.
    MYRIAD_FUNCTION reals values_ahead(int i, const lane_data<Model, S>& at, const state& slope) const {
        const R t = get_lane(sides.s.now(), i), ahead = copysign(past_jump(i), get_lane(at.t_end, i) - t);
        state y = get_lanes<R>(at.y, i);
        MYRIAD_UNROLL
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c) {
            const R rounding = R(roundings_ahead) * epsilon_of<R> * abs(y[c]);
            y[c] += fma(ahead, slope[c], sign_of(slope[c]) * sign_of(ahead) * rounding);
        }
        return detail::evaluate_events<Model>(t + ahead, y, sides.inputs_of(i, at));
    }
    /// A time after which the state has passed the jumps right before it: longer where it moves slowly.
    MYRIAD_FUNCTION R time_to_pass(int i, const state& slope, const reals& there) const {
        const auto& s = sides.s;
        const R t = get_lane(s.now(), i);
        const flags on_jump = sides.memory_of(i).on_jump;
        R ahead = copysign(past_jump(i), get_lane(s.data.t_end, i) - t);
        MYRIAD_ROLLED
        for (int k = 0; k < most_doublings; ++k) {
            state y = get_lanes<R>(s.data.y, i);
            MYRIAD_UNROLL
            for (int c = 0; c < MYRIAD_LENGTH(n); ++c) y[c] = fma(ahead, slope[c], y[c]);
            const reals g = detail::evaluate_events<Model>(t + ahead, y, sides.inputs_of(i));
            bool passed = true;
            MYRIAD_UNROLL
            for (int j = 0; j < MYRIAD_LENGTH(m); ++j) passed = passed && (!on_jump[j] || g[j] * there[j] > R(0));
            ahead *= R(2);
            if (passed) break;
        }
        return abs(ahead);
    }
    /// Sets the sides of functions at a jump, with values g here, to those a little ahead.
    MYRIAD_FUNCTION void take_sides_ahead(int i, const flags& at_jump, const reals& g, const state& slope) const {
        const reals there = values_ahead(i, sides.s.data, slope);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            if (!at_jump[j] || !(there[j] > R(0) || there[j] < R(0))) continue;
            sides.put_side(j, i, sign_of(there[j]));
            if (g[j] * there[j] < R(0)) {
                sides.e.left.set(j, i, false);
                sides.memory_of(i).on_jump.set(j, true);
            }
        }
        if (sides.memory_of(i).on_jump.any_of()) sides.memory_of(i).jump_time = time_to_pass(i, slope, there);
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
