// SPDX-License-Identifier: MIT
// Tracks the side of zero that each event function is on from phase to phase, through hooks and events. It works on one
// lane, or is rarely called; the check in every step is `event_detector::detect`.
#pragma once

#include "myriad/kernel/event/fired_events.hpp"
#include "myriad/kernel/event/lane_sides.hpp"
#include "myriad/kernel/event/side_resolver.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The usual ways: signs decide. Where rounding, a surface or a jump does, `side_resolver` has the general ones.
template <class Model, class Method, class S>
struct side_tracker {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr auto m = n_event<Model>;
    using values = vec<S, m>;  // of the event functions in all lanes
    using reals = vec<R, m>;   // in one lane
    using flags = mask_set<bool, m>;
    using fired = fired_events<Model, S>;
    using resolver = side_resolver<Model, Method, S>;

    lane_sides<Model, Method, S> sides;

    /// Starts a phase of lane i with the sides that the previous one left.
    MYRIAD_FUNCTION void begin(int i) const {
        const auto& s = sides.s;
        auto& e = sides.e;
        sides.memory_of(i).clear();
        const reals g =
            detail::evaluate_events<Model>(get_lane(s.now(), i), get_lanes<R>(s.data.y, i), sides.inputs_of(i));
        e.above.set_of_lane(i, ~negative(g));
        e.left.set_of_lane(i, flags::all_in(true));
        e.flags.set(e.undefined, i, false);
        e.flags.set(e.locating, i, false);
        e.flags.set(e.in_question, i, sides.args.sub_samples > 1);
        bool clear = sides.are_beyond_tolerances(g);
        if (!e.flags.get(e.kept_plain, i)) {
            MYRIAD_UNROLL
            for (int j = 0; j < MYRIAD_LENGTH(m); ++j) clear = clear && kept_event(sides.kept_at(j, i)).is_plain();
        }
        if (MYRIAD_UNLIKELY(!clear)) resolver{sides}.begin(i, g);
    }
    /// Stores the sides of lane i for its next phase. A phase without a step has not evaluated its event functions.
    MYRIAD_FUNCTION void store(int i) const {
        const auto& s = sides.s;
        auto& e = sides.e;
        if (s.iterations_of(sides.args, i) == 0) return;
        const auto& own = sides.memory_of(i);
        const reals g =
            detail::evaluate_events<Model>(get_lane(s.data.t, i), get_lanes<R>(s.data.y, i), sides.inputs_of(i));
        const flags above = e.above.of_lane(i);
        const bool clear = (above ^ negative(g)).all_of() && e.left.of_lane(i).all_of() &&
                           sides.are_beyond_tolerances(g) && !(own.open | own.on_jump).any_of();
        e.flags.set(e.kept_plain, i, clear);
        if (MYRIAD_UNLIKELY(!clear)) return resolver{sides}.store(i, g);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j)
            sides.kept_at(j, i) = kept_event(above[j], kept_side::beyond, 0).code();
    }
    /// Takes the sides of an instance that is new in lane i from where an earlier call has kept them.
    MYRIAD_FUNCTION void load(int i) const { sides.e.flags.set(sides.e.kept_plain, i, false); }
    /// Makes the next phase of lane i begin with all sides unknown.
    MYRIAD_FUNCTION void reset(int i) const {
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) sides.kept_at(j, i) = 0;
    }

    /// Updates the sides after a hook changed inputs of event functions, whose values were `before`. A function that
    /// the hook moved is on the side where it is now or, on the surface, where the slope at the next step leads.
    /// One at a jump keeps the side beyond it, which its value here does not show, until `update_after_events`, or
    /// until an action of a stop or a trigger, which come after those of events, moves it.
    MYRIAD_FUNCTION void update_after_hook(const mask& lanes, const values& before, const fired& events) const {
        auto& e = sides.e;
        const values g = detail::evaluate_events<Model>(sides.s.now(), sides.s.data.y, sides.s.data);
        for_each_lane(lanes, [&](int i) MYRIAD_LAMBDA {
            auto& own = sides.memory_of(i);
            bool undefined = false;
            flags moved;
            moved.clear();
            const bool events_are_over = acts_after_events && !events.which.of_lane(i).any_of();
            MYRIAD_UNROLL
            for (int j = 0; j < MYRIAD_LENGTH(m); ++j)
                moved.set(j, !events.which.get(j, i) && (events_are_over || !own.on_jump[j]) &&
                                 get_lane(g[j], i) != get_lane(before[j], i));
            if (acts_after_events) own.on_jump = own.on_jump & ~moved;
            const reals rounding = sides.roundings_if_needed(i, get_lanes<R>(g, i), moved);
            MYRIAD_UNROLL
            for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
                const R now = get_lane(g[j], i), then = get_lane(before[j], i);
                undefined = undefined || now != now;
                if (!moved[j]) continue;
                const bool is_there = abs(now) <= rounding[j], was_there = abs(then) <= rounding[j];
                // Right after its event a function that a hook hardly moves is as good as on the surface.
                const R residual = min(R(2) * abs(then), sides.args.event[j].tolerance);
                const bool keeps = is_there ? was_there : !e.left.get(j, i) && abs(now) <= residual;
                if (keeps) continue;
                sides.put_side(j, i, is_there ? R(0) : sign_of(now));
                if (acts_after_events) e.left.set(j, i, e.left.get(j, i) || !is_there);
            }
            e.flags.set(e.undefined, i, undefined);
            sides.update_in_question(i);
        });
    }

    /// Updates the sides of lane i after the actions of its events; `before` is the data before them. Nearly always the
    /// functions that fired, and no others, have changed sides.
    MYRIAD_FUNCTION void update_after_events(int i, const fired& events, const lane_data<Model, S>& before) const {
        auto& e = sides.e;
        auto& own = sides.memory_of(i);
        const flags which = events.which.of_lane(i), left = e.left.of_lane(i);
        own.fresh = own.fresh | which;
        const bool passes =
            !get_lane(events.changed, i) && !e.flags.get(e.in_question, i) && !(which & (~left | own.at_jump)).any_of();
        if (!passes) return resolver{sides}.update_after_events(i, events, before);
        e.above.set_of_lane(i, e.above.of_lane(i) ^ which);
        e.left.set_of_lane(i, left & ~which);
    }

private:
    static constexpr bool acts_after_events = has_triggers<Model> || has_stops<Model>;

    static MYRIAD_FUNCTION flags negative(const reals& g) {
        flags below;
        below.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) below.set_negative(j, g[j]);
        return below;
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
