// SPDX-License-Identifier: MIT
// Tracks the side of zero that each event function is on through steps, hooks and phases. It works on one lane, or is
// rarely called; the check in every step is `event_detector::watch`.
#pragma once

#include <cstdint>
#include <type_traits>

#include "myriad/kernel/event/event_memory.hpp"
#include "myriad/kernel/event/event_sides.hpp"
#include "myriad/kernel/event/fired_events.hpp"
#include "myriad/kernel/event/step_ends.hpp"
#include "myriad/kernel/state/integration_state.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class R>
MYRIAD_FUNCTION R sign_of(R x) {
    return x > R(0) ? R(1) : x < R(0) ? R(-1) : R(0);
}

/// The sides of a pack's event functions. A crossing is a change of side. The side on which a function was last seen is
/// remembered, so that one that lands on zero is not lost, and one that only touches zero does not fire. Values within
/// rounding of zero count as zero. Right after its event a function may still be short of the surface, as closely as
/// the event was located, but counts as on the side that its slope along the solution is heading for.
template <class Model, class Method, class S>
struct side_follower {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr int n = n_state<Model>;
    static constexpr int m = n_event<Model>;
    using values = vec<S, m>;  // of the event functions in all lanes
    using reals = vec<R, m>;   // in one lane
    using masks = mask_set<mask, m>;
    using flags = mask_set<bool, m>;
    using state = vec<R, n>;
    using fired = fired_events<Model, S>;

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S>& s;
    event_sides<Model, S>& e;
    event_memory<Model, R>* memory;  // of each lane

    MYRIAD_FUNCTION event_memory<Model, R>& memory_of(int i) const {
        auto* own = memory + i;
        MYRIAD_FORGET(own);  // else nvcc keeps the values it points to in registers
        return *own;
    }

    /// Starts a phase with the sides that the previous one left.
    MYRIAD_FUNCTION void begin(const mask& lanes) {
        for_each_lane(lanes, [&](int i) MYRIAD_LAMBDA { begin_lane(i); });
    }

    /// Stores the sides of lane i for its next phase. A phase without a step has not evaluated its event functions.
    MYRIAD_FUNCTION void keep(int i) const {
        if (s.iterations_of(args, i) == 0) return;
        const auto& own = memory_of(i);
        const reals g = detail::evaluate_events<Model>(get_lane(s.data.t, i), get_lanes<R>(s.data.y, i), inputs_of(i));
        const flags above = e.above.of_lane(i);
        const bool clear = (above ^ negative(g)).all_of() && e.left.of_lane(i).all_of() && are_beyond_tolerances(g) &&
                           !(own.open | own.on_jump).any_of();
        e.flags.set(e.kept_plain, i, clear);
        if (MYRIAD_UNLIKELY(!clear)) return keep_carefully(i, g);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) kept_at(j, i) = kept_event(above[j], kept_side::beyond, 0).code();
    }
    /// Takes the sides of an instance that is new in lane i from where an earlier call has kept them.
    MYRIAD_FUNCTION void load(int i) const { e.flags.set(e.kept_plain, i, false); }
    /// Makes the next phase of lane i begin with all sides unknown.
    MYRIAD_FUNCTION void forget(int i) const {
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) kept_at(j, i) = 0;
    }

    /// Updates the sides after a hook changed inputs of event functions, whose values were `before`. A function that
    /// the hook moved has the side on which it is now or, on the surface, that which the slope at the next step shows.
    /// One at a jump keeps the side beyond it, which its value here does not show, until `settle` looks again.
    MYRIAD_FUNCTION void restart(const mask& lanes, const values& before, const fired& events) {
        const values g = detail::evaluate_events<Model>(s.now(), s.data.y, s.data);
        for_each_lane(lanes, [&](int i) MYRIAD_LAMBDA {
            auto& own = memory_of(i);
            bool undefined = false;
            flags moved;
            moved.clear();
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j)
                moved.set(j, !events.which.get(j, i) && !own.on_jump[j] && get_lane(g[j], i) != get_lane(before[j], i));
            const reals rounding = roundings_if_needed(i, get_lanes<R>(g, i), moved);
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j) {
                const R now = get_lane(g[j], i), then = get_lane(before[j], i);
                undefined = undefined || now != now;
                if (!moved[j]) continue;
                const bool is_there = abs(now) <= rounding[j], was_there = abs(then) <= rounding[j];
                // Right after its event a function that a hook hardly moves is as good as on the surface.
                const bool keeps = is_there ? was_there : !e.left.get(j, i) && abs(now) <= R(2) * abs(then);
                if (!keeps) put_side(j, i, is_there ? R(0) : sign_of(now));
            }
            e.flags.set(e.undefined, i, undefined);
            note(i);
        });
    }

    /// Determines the sides after the actions of events; `before` is the data before them. A function that fired is on
    /// the side it is heading for. If its slope is zero, it stays on the side it came from if an action changed it, and
    /// has crossed if none did. If it was still moving away when it fired, as in a flight too short for the resolution
    /// of the state, an action that reversed it must not send it through the surface. A function with a jump fired
    /// right before the jump: a look ahead tells whether it is about to pass it. The same holds for one that fired at a
    /// jump earlier, as this action may have moved the state.
    MYRIAD_FUNCTION void settle(int i, const fired& events, const lane_data<Model, S>& before) {
        auto& own = memory_of(i);
        const flags which = events.which.of_lane(i), left = e.left.of_lane(i);
        own.fresh = own.fresh | which;
        const bool passes =
            !get_lane(events.changed, i) && !e.flags.get(e.in_question, i) && !(which & (~left | own.at_jump)).any_of();
        if (!passes) return settle_with_care(i, events, before);
        e.above.set_of_lane(i, e.above.of_lane(i) ^ which);
        e.left.set_of_lane(i, left & ~which);
    }

    /// The inputs of lane i's event functions beside t and y.
    MYRIAD_FUNCTION decltype(auto) inputs_of(int i) const { return inputs_of(i, s.data); }
    MYRIAD_FUNCTION decltype(auto) inputs_of(int i, const lane_data<Model, S>& at) const {
        if constexpr (is_pack<S>) {
            return detail::extract_lane(at, i);
        } else {
            return static_cast<const inputs<Model, S>&>(at);
        }
    }
    /// +1, -1, or 0 if the side is not yet known.
    MYRIAD_FUNCTION R side_of(int j, int i) const {
        return memory_of(i).open[j] ? R(0) : e.above.get(j, i) ? R(1) : R(-1);
    }
    MYRIAD_FUNCTION void put_side(int j, int i, R side) {
        memory_of(i).open.set(j, side == R(0));
        memory_of(i).held.set(j, false);
        e.above.set(j, i, side > R(0));
    }
    /// Notes whether the next trial of lane i has to be looked at closely. To be called after what decides it changed.
    MYRIAD_FUNCTION void note(int i) {
        const auto& own = memory_of(i);
        e.flags.set(e.in_question, i, own.locating || (own.open | own.on_jump).any_of() || args.sub_samples > 1);
    }
    /// The crossings that are events, from where the functions are.
    MYRIAD_FUNCTION masks asked() const {
        const masks& above = e.above;
        return (above & masks::from_bits(args.falling)) | (~above & masks::from_bits(args.rising));
    }
    /// Whether event j fires when its function crosses from the given side.
    MYRIAD_FUNCTION bool is_asked(int j, R side) const {
        const std::uint32_t asked = side > R(0) ? args.falling[j / 32] : side < R(0) ? args.rising[j / 32] : 0u;
        return ((asked >> (j % 32)) & 1u) != 0;
    }
    /// Whether a function with value g has crossed from the given side, by more than `past`.
    MYRIAD_FUNCTION bool crosses(int j, R side, R g, R past) const { return is_asked(j, side) && side * g < -past; }

    /// Sets open sides to where the functions, on the surface at the start of the step, are heading. The side that a
    /// phase has kept for one there stands, unless its event fired there: then the host may have turned the flow round,
    /// which shows in a slope that is not rounding itself.
    MYRIAD_FUNCTION void settle_open_sides(int i, const step_ends<Model, R>& step, const reals& rounding) {
        const auto& own = memory_of(i);
        const flags open = own.open, held = own.held, fired_last = own.fired_last;
        if (!open.any_of()) return;
        const reals slope = step.slopes();
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            if (!open[j]) continue;
            const bool turns = fired_last[j] && abs(slope[j] * step.h) > rounding[j];
            const R heading =
                held[j] && !turns ? (e.above.get(j, i) ? R(1) : R(-1)) : sign_of(slope[j]) * sign_of(step.h);
            put_side(j, i, heading);
        }
    }

    /// Whether event j fired at a jump that a state within `length` of it may not have passed: if another event is
    /// located right after that one, rounding may leave the state before the jump.
    MYRIAD_FUNCTION bool is_at_jump(int j, int i, R length) const {
        const auto& own = memory_of(i);
        return own.on_jump[j] && abs(length) <= own.jump_time;
    }
    /// Whether `length` is within the rounding of t: values that near do not show that a function has left the place
    /// where it fired.
    MYRIAD_FUNCTION bool is_timeless(int i, R length) const {
        return abs(length) <= R(4) * epsilon_of<R> * abs(get_lane(s.now(), i));
    }

    /// Updates the sides at the end of an accepted trial that was looked at closely; `side` holds those before it. A
    /// function within its `band` has not left the surface.
    MYRIAD_FUNCTION void follow(int i, const step_ends<Model, R>& step, const reals& side) {
        const bool timeless = is_timeless(i, step.h);
        auto& own = memory_of(i);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            if (is_at_jump(j, i, step.h)) continue;  // after the trial it is still at the jump where it fired
            own.on_jump.set(j, false);
            own.fresh.set(j, false);
            put_side(j, i, abs(step.g1[j]) > own.near.past(j) ? sign_of(step.g1[j]) : side[j]);
            e.left.set(j, i, e.left.get(j, i) || (abs(step.g1[j]) > own.near.band(j) && !timeless));
        }
    }

private:
    /// The same if a function may be on its surface or at a jump.
    MYRIAD_FUNCTION void keep_carefully(int i, const reals& g) const {
        const auto& own = memory_of(i);
        flags in_question;
        in_question.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) in_question.set(j, !is_fresh(j, i));
        const reals rounding = roundings_if_needed(i, g, in_question);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const R side = side_of(j, i);
            kept_side kept = side * g[j] > rounding[j] ? kept_side::beyond : kept_side::within;
            if (is_fresh(j, i)) kept = kept_side::fired;
            if (!e.left.get(j, i) && own.on_jump[j]) kept = kept_side::on_jump;
            if (side == R(0)) kept = kept_side::unknown;
            const kept_event all(side > R(0), kept, e.left.get(j, i) ? 0 : own.lingered[j]);
            kept_at(j, i) = (kept == kept_side::fired ? all.at_value(g[j]) : all).code();
        }
    }
    MYRIAD_FUNCTION std::int32_t& kept_at(int j, int i) const {
        return args.side[static_cast<std::int64_t>(j) * args.size + s.instance[i]];
    }
    MYRIAD_FUNCTION bool fires_at_jump(int j, int i, const fired& events) const {
        return events.which.get(j, i) && memory_of(i).at_jump[j];
    }
    /// The rounding errors of the event functions g at the committed state, or zero if those in question are farther
    /// from the surface than the tolerances that were given, and so than rounding.
    MYRIAD_FUNCTION reals roundings_if_needed(int i, const reals& g, const flags& in_question) const {
        bool clear = true;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) clear = clear && (!in_question[j] || is_beyond_tolerance(j, g[j]));
        if (clear) return reals{};
        return detail::event_roundings<Model>(get_lane(s.now(), i), get_lanes<R>(s.data.y, i), inputs_of(i));
    }
    /// Whether a value is farther from the surface than the tolerance that was given.
    MYRIAD_FUNCTION bool is_beyond_tolerance(int j, R g) const {
        return abs(g) > args.event[j].tolerance && args.event[j].tolerance > R(0);
    }
    static MYRIAD_FUNCTION flags negative(const reals& g) {
        flags below;
        below.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) below.set_negative(j, g[j]);
        return below;
    }
    MYRIAD_FUNCTION bool are_beyond_tolerances(const reals& g) const {
        bool beyond = true;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) beyond = beyond && is_beyond_tolerance(j, g[j]);
        return beyond;
    }
    /// Whether event j fired at the committed state. After an ordinary step every function has left.
    MYRIAD_FUNCTION bool is_fresh(int j, int i) const { return memory_of(i).fresh[j] && !e.left.get(j, i); }
    /// Slopes of the event functions of lane i along the solution, from the data `at`. For a function right before a
    /// jump, where the slope is zero, a number of the sign that it would have: towards the jump if the function is past
    /// it a little ahead.
    MYRIAD_FUNCTION reals headings(int i, const lane_data<Model, S>& at, const fired& events) {
        const state along = s.slopes.of_lane(i, s.now(), at, s.extra_evaluations);
        const auto& p = inputs_of(i, at);
        reals slope = detail::event_slopes<Model>(get_lane(s.now(), i), get_lanes<R>(at.y, i), along, p);
        bool jumps = false;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) jumps = jumps || fires_at_jump(j, i, events);
        if (!jumps) return slope;
        const reals g = look_ahead(i, at, along);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            if (!fires_at_jump(j, i, events)) continue;
            const R side = side_of(j, i);
            slope[j] = (g[j] * side > R(0) ? side : -side) * sign_of(get_lane(s.h, i));
        }
        return slope;
    }
    /// `settle` for a lane in which a hook has changed inputs of the event functions, or a function that fired has a
    /// jump or had not left its surface before.
    MYRIAD_FUNCTION void settle_with_care(int i, const fired& events, const lane_data<Model, S>& found) {
        const R sense = sign_of(get_lane(s.h, i));
        auto& on_jump = memory_of(i).on_jump;
        const reals before = headings(i, found, events);
        reals g = get_lanes<R>(events.value, i), slope = before;
        bool known = !get_lane(events.changed, i);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) known = known && !on_jump[j] && !fires_at_jump(j, i, events);
        state along;  // the slope of the state, where it is needed
        if (!known) {
            along = s.slope_of(i);
            const auto& p = inputs_of(i);
            const R t = get_lane(s.now(), i);
            const state y = get_lanes<R>(s.data.y, i);
            g = detail::evaluate_events<Model>(t, y, p);
            slope = detail::event_slopes<Model>(t, y, along, p);
        }
        flags at_jump, in_question;
        at_jump.clear();
        in_question.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const bool moved = g[j] != get_lane(events.value[j], i);
            in_question.set(j, moved || on_jump[j] || fires_at_jump(j, i, events));
        }
        const reals rounding = roundings_if_needed(i, g, in_question);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const bool fires = events.which.get(j, i), waits = !fires && on_jump[j];
            const bool jumps = fires_at_jump(j, i, events);
            // An event's action that hardly moves its function leaves it on the surface, as closely as it was located.
            const R residual = fires && !jumps ? R(2) * abs(get_lane(events.value[j], i)) : R(0);
            const bool beyond = abs(g[j]) > max(rounding[j], residual);
            if (g[j] != g[j]) e.flags.set(e.undefined, i, true);
            if (waits) {
                at_jump.set(j, beyond);
                on_jump.set(j, false);
                put_side(j, i, beyond ? sign_of(g[j]) : R(0));
            } else if (fires) {
                const R from = side_of(j, i), ahead = sign_of(slope[j]) * sense;
                const bool moved = g[j] != get_lane(events.value[j], i);
                const bool acted = moved || slope[j] != before[j];
                const bool unresolved = from * sign_of(before[j]) * sense > R(0);
                const bool rests = ahead == R(0) && !e.left.get(j, i);
                at_jump.set(j, jumps && (moved || !unresolved) && beyond);
                R side = ahead;
                if (unresolved || ahead == R(0)) side = acted || rests ? from : -from;
                if (moved && beyond) side = sign_of(g[j]);
                on_jump.set(j, false);
                e.left.set(j, i, moved && beyond);
                put_side(j, i, side);
            } else if (beyond) {
                e.left.set(j, i, e.left.get(j, i) || g[j] != get_lane(events.value[j], i));
            }
        }
        if (MYRIAD_UNLIKELY(!known && at_jump.any_of())) look_beyond(i, at_jump, g, along);
        note(i);
    }

    MYRIAD_FUNCTION void begin_lane(int i) {
        memory_of(i).clear();
        const reals g = detail::evaluate_events<Model>(get_lane(s.now(), i), get_lanes<R>(s.data.y, i), inputs_of(i));
        e.above.set_of_lane(i, ~negative(g));
        e.left.set_of_lane(i, flags::all_in(true));
        e.flags.set(e.undefined, i, false);
        e.flags.set(e.in_question, i, args.sub_samples > 1);
        bool clear = are_beyond_tolerances(g);
        if (!e.flags.get(e.kept_plain, i)) {
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j) clear = clear && kept_event(kept_at(j, i)).is_plain();
        }
        if (MYRIAD_UNLIKELY(!clear)) begin_carefully(i, g);
    }
    /// The same if a function may be on its surface, at a jump, or undefined.
    MYRIAD_FUNCTION void begin_carefully(int i, const reals& g) {
        auto& own = memory_of(i);
        bool undefined = false;
        flags at_jump, in_question;
        at_jump.clear();
        in_question.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const bool fired_there = kept_event(kept_at(j, i)).kind() == kept_side::fired;
            in_question.set(j, !(fired_there && args.event[j].tolerance > R(0)));
        }
        const reals rounding = roundings_if_needed(i, g, in_question);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const kept_event kept(kept_at(j, i));
            const kept_side kind = kept.kind();
            const bool fired = kind == kept_side::fired, keeps = fired || kind == kept_side::within;
            const R tolerance = max(args.event[j].tolerance, rounding[j]);
            // An event is located only as closely as the time resolves, and that may have started anew.
            const R band = fired ? max(tolerance, kept.template value_bound<R>()) : keeps ? tolerance : rounding[j];
            const bool beyond = abs(g[j]) > band;
            undefined = undefined || g[j] != g[j];
            at_jump.set(j, beyond && kind == kept_side::on_jump);
            // Flights that accumulate may do so over many phases that another event ends.
            own.lingered[j] = abs(g[j]) > tolerance ? 0 : kept.lingered();
            e.left.set(j, i, own.lingered[j] == 0);
            put_side(j, i, beyond ? sign_of(g[j]) : R(0));
            own.fired_last.set(j, fired);
            if (keeps && !beyond) {
                e.above.set(j, i, kept.above());
                own.open.set(j, true);
                own.held.set(j, true);
            }
        }
        e.flags.set(e.undefined, i, undefined);
        if (at_jump.any_of()) look_beyond(i, at_jump, g, s.slope_of(i));
        note(i);
    }

    /// The roundings that a look ahead of a jump is long.
    static constexpr double roundings_ahead = 64;
    /// Of a time of so many roundings, until a state has moved by its own rounding.
    static constexpr int most_doublings = 64;
    /// A time longer than the rounding of t, and than the error of the last location at a jump.
    MYRIAD_FUNCTION R past_jump(int i) const {
        const R error = epsilon_of<R> * abs(get_lane(s.now(), i)) + memory_of(i).redo.error();
        return R(roundings_ahead) * error;
    }
    /// The event functions a little ahead, by the rounding of t and of the state: beyond a jump to which a step was
    /// located, if the state is heading for it. A longer look would pass the next event, too, of a state close to it.
    MYRIAD_FUNCTION reals look_ahead(int i, const lane_data<Model, S>& at, const state& slope) const {
        const R t = get_lane(s.now(), i), ahead = copysign(past_jump(i), get_lane(at.t_end, i) - t);
        state y = get_lanes<R>(at.y, i);
        MYRIAD_UNROLL
        for (int c = 0; c < n; ++c) {
            const R rounding = R(roundings_ahead) * epsilon_of<R> * abs(y[c]);
            y[c] += fma(ahead, slope[c], sign_of(slope[c]) * sign_of(ahead) * rounding);
        }
        return detail::evaluate_events<Model>(t + ahead, y, inputs_of(i, at));
    }
    /// A time after which the state has passed the jumps right before it: longer where it moves slowly.
    MYRIAD_FUNCTION R time_to_pass(int i, const state& slope, const reals& there) const {
        const R t = get_lane(s.now(), i);
        const flags on_jump = memory_of(i).on_jump;
        R ahead = copysign(past_jump(i), get_lane(s.data.t_end, i) - t);
        MYRIAD_ROLLED
        for (int k = 0; k < most_doublings; ++k) {
            state y = get_lanes<R>(s.data.y, i);
            MYRIAD_UNROLL
            for (int c = 0; c < n; ++c) y[c] = fma(ahead, slope[c], y[c]);
            const reals g = detail::evaluate_events<Model>(t + ahead, y, inputs_of(i));
            bool passed = true;
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j) passed = passed && (!on_jump[j] || g[j] * there[j] > R(0));
            ahead *= R(2);
            if (passed) break;
        }
        return abs(ahead);
    }
    /// Sets the sides of functions at a jump, with values g here, to those a little ahead.
    MYRIAD_FUNCTION void look_beyond(int i, const flags& at_jump, const reals& g, const state& slope) {
        const reals there = look_ahead(i, s.data, slope);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            if (!at_jump[j] || !(there[j] > R(0) || there[j] < R(0))) continue;
            put_side(j, i, sign_of(there[j]));
            if (g[j] * there[j] < R(0)) {
                e.left.set(j, i, false);
                memory_of(i).on_jump.set(j, true);
            }
        }
        if (memory_of(i).on_jump.any_of()) memory_of(i).jump_time = time_to_pass(i, slope, there);
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
