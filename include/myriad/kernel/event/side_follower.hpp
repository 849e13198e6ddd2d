// SPDX-License-Identifier: MIT
// Follows the side of zero that each event function is on: through steps, hooks and phases. All of it is for one lane,
// or rare, but what `event_locator::look` does for every step.
#pragma once

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

/// The sides of a pack's event functions. A crossing is a change of side: the side an event function was last seen on,
/// beyond its tolerance, is remembered, so a function that lingers within the tolerance neither fires twice nor is
/// lost, and one that only touches zero does not fire. Where a step starts within the tolerance, the slope of the
/// function along the solution tells where it is heading.
template <class Model, class Method, class S>
struct side_follower {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr int n = n_state<Model>;
    static constexpr int m = n_event<Model>;
    using values = vec<S, m>;  // of the event functions in all lanes
    using reals = vec<R, m>;   // in one
    using flags = mask_set<bool, m>;
    using state = vec<R, n>;
    using fired = fired_events<Model, S>;

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S>& s;
    event_sides<Model, S>& e;
    event_memory<Model, R>* memory;  // of each lane

    MYRIAD_FUNCTION event_memory<Model, R>& memory_of(int i) const {
        auto* own = memory + i;
        MYRIAD_FORGET(own);  // else a GPU's compiler keeps what it points to in registers
        return *own;
    }

    /// Takes the sides at the start of a phase, with which the one before ended.
    MYRIAD_FUNCTION void begin(const mask& lanes) {
        for_each_lane(lanes, [&](int i) MYRIAD_LAMBDA { begin_lane(i); });
    }

    /// Leaves the sides of lane i to its next phase. A phase without a step has not looked at its event functions.
    MYRIAD_FUNCTION void keep(int i) const {
        if (s.iteration == s.phase_start[i]) return;
        const auto& p = inputs_of(i);
        const reals g = detail::evaluate_events<Model>(get_lane(s.data.t, i), get_lanes<R>(s.data.y, i), p);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const bool left = e.left.get(j, i);
            kept_side kept = left ? kept_side::within : kept_side::unknown;
            if (abs(g[j]) > args.event[j].tolerance || (e.on_jump.get(j, i) && !left))
                kept = left ? kept_side::beyond : kept_side::on_jump;
            const int sign = e.open.get(j, i) ? 0 : e.above.get(j, i) ? 1 : -1;
            kept_at(j, i) = static_cast<std::int8_t>(sign * static_cast<int>(kept));
        }
    }
    /// Makes the next phase of lane i begin with no side known.
    MYRIAD_FUNCTION void forget(int i) const {
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) kept_at(j, i) = 0;
    }

    /// Takes the event functions after a hook changed what they depend on, from the values `before`. A function within
    /// its tolerance keeps its side, unless the hook moved it there: then the slope at the next step decides. One that
    /// is on a jump keeps the side beyond it, which its value here does not show, until `settle` looks again.
    MYRIAD_FUNCTION void restart(const mask& lanes, const values& before, const fired& events) {
        const values g = detail::evaluate_events<Model>(s.now(), s.data.y, s.data);
        e.undefined = e.undefined & !lanes;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const S tolerance = S(args.event[j].tolerance);
            const mask adopted = lanes & !events.which[j] & !e.on_jump[j];
            const mask beyond = abs(g[j]) > tolerance;
            e.undefined = e.undefined | (lanes & (g[j] != g[j]));
            e.open.set(j, (e.open[j] & !(adopted & beyond)) | (adopted & !beyond & (abs(before[j]) > tolerance)));
            e.above.set(j, (e.above[j] & !(adopted & beyond)) | (adopted & beyond & (g[j] > S(R(0)))));
        }
    }

    /// Before the actions of events: whether a function right before a jump is heading for it, which its slope, zero,
    /// does not tell. It is not where a flight is too short for the resolution of t.
    MYRIAD_FUNCTION void aim(int i, fired& events) {
        bool jumps = false;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) jumps = jumps || fires_at_jump(j, i, events);
        if (!jumps) return;
        const reals g = look_ahead(i, s.slope_of(i));
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            if (!fires_at_jump(j, i, events)) continue;
            const R side = side_of(j, i);
            set_lane(events.slope[j], i, (g[j] * side > R(0) ? side : -side) * sign_of(get_lane(s.h, i)));
        }
    }

    /// Decides on which sides the functions are after the actions of events. One that fired is on the side it is
    /// heading for. If its slope is zero, it rests on the side it came from if an action changed it, and has passed if
    /// none did. If it was still moving away when it fired, as in a flight too short for the resolution of the state,
    /// an action that turned it round must not send it through the surface. One that jumps fired right before the jump:
    /// a look ahead tells whether it is about to pass. The same holds for one that fired at a jump earlier, as this
    /// action may have moved the state.
    MYRIAD_FUNCTION void settle(int i, const fired& events) {
        const R sense = sign_of(get_lane(s.h, i));
        reals g = get_lanes<R>(events.value, i), slope = get_lanes<R>(events.slope, i);
        bool known = !get_lane(events.changed, i);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) known = known && !e.on_jump.get(j, i) && !fires_at_jump(j, i, events);
        state along;  // the slope of the state, where it is needed
        if (!known) {
            along = s.slope_of(i);
            const auto& p = inputs_of(i);
            const R t = get_lane(s.now(), i);
            const state y = get_lanes<R>(s.data.y, i);
            g = detail::evaluate_events<Model>(t, y, p);
            slope = detail::event_slopes<Model>(t, y, along, p);
        }
        flags at_jump;
        at_jump.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const bool fires = events.which.get(j, i), waits = !fires && e.on_jump.get(j, i);
            const bool beyond = abs(g[j]) > args.event[j].tolerance;
            if (g[j] != g[j]) set_lane(e.undefined, i, true);
            if (waits) {
                at_jump.set(j, beyond);
                e.on_jump.set(j, i, false);
                put_side(j, i, beyond ? sign_of(g[j]) : R(0));
            } else if (fires) {
                const R before = get_lane(events.slope[j], i), from = side_of(j, i), ahead = sign_of(slope[j]) * sense;
                const bool moved = g[j] != get_lane(events.value[j], i);
                const bool acted = moved || slope[j] != before;
                const bool unresolved = from * sign_of(before) * sense > R(0);
                const bool rests = ahead == R(0) && !e.left.get(j, i);
                at_jump.set(j, (moved || !unresolved) && beyond);
                R side = ahead;
                if (unresolved || ahead == R(0)) side = acted || rests ? from : -from;
                if (moved && beyond) side = sign_of(g[j]);
                e.on_jump.set(j, i, false);
                e.left.set(j, i, moved && beyond);
                put_side(j, i, side);
            } else if (beyond) {
                e.left.set(j, i, e.left.get(j, i) || g[j] != get_lane(events.value[j], i));
            }
        }
        if (MYRIAD_UNLIKELY(!known && at_jump.any_of())) look_beyond(i, at_jump, g, along);
    }

    /// What the event functions of lane i read beside t and y.
    MYRIAD_FUNCTION decltype(auto) inputs_of(int i) const {
        if constexpr (is_pack<S>) {
            return detail::extract_lane(s.data, i);
        } else {
            return static_cast<const inputs<Model, S>&>(s.data);
        }
    }
    /// +1, -1, or 0 where the side is not yet known.
    MYRIAD_FUNCTION R side_of(int j, int i) const { return e.open.get(j, i) ? R(0) : e.above.get(j, i) ? R(1) : R(-1); }
    MYRIAD_FUNCTION void put_side(int j, int i, R side) {
        e.open.set(j, i, side == R(0));
        e.above.set(j, i, side > R(0));
    }
    /// Whether event j is to fire where its function crosses from the given side.
    MYRIAD_FUNCTION bool is_asked(int j, R side) const {
        return (side > R(0) && args.event[j].falling) || (side < R(0) && args.event[j].rising);
    }
    /// Whether a function that was on the given side has crossed, by its value g.
    MYRIAD_FUNCTION bool crosses(int j, R side, R g) const {
        return is_asked(j, side) && side * g < -args.event[j].tolerance;
    }

    /// Settles sides that are open by where the functions are heading.
    MYRIAD_FUNCTION void settle_open_sides(int i, const step_ends<Model, R>& step) {
        bool open = false;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) open = open || e.open.get(j, i);
        if (!open) return;
        const reals slope = step.slopes();
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j)
            if (e.open.get(j, i)) put_side(j, i, sign_of(slope[j]) * sign_of(step.h));
    }

    /// Whether event j fired at a jump which a state as near as `length` may not show to be passed: rounding may leave
    /// it before the jump, where another event is located right after that one.
    MYRIAD_FUNCTION bool is_at_jump(int j, int i, R length) const {
        if (!e.on_jump.get(j, i)) return false;
        return abs(length) <=
               past_jump(i, get_lane(e.locating, i) ? memory_of(i).redo.resume : get_lane(s.data.h_next, i));
    }
    /// Whether `length` is no more than the rounding of t: what is seen there does not say that functions have left
    /// where they fired.
    MYRIAD_FUNCTION bool is_timeless(int i, R length) const {
        return abs(length) <= R(4) * epsilon_of<R> * abs(get_lane(s.now(), i));
    }

    /// Takes the sides at the end of a trial that is accepted; `side` holds those before it.
    MYRIAD_FUNCTION void follow(int i, const step_ends<Model, R>& step, const reals& side) {
        const bool timeless = is_timeless(i, step.h);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            if (is_at_jump(j, i, step.h)) continue;  // the trial leaves it on the jump at which it fired
            const bool beyond = abs(step.g1[j]) > args.event[j].tolerance;
            e.on_jump.set(j, i, false);
            put_side(j, i, beyond ? sign_of(step.g1[j]) : side[j]);
            e.left.set(j, i, e.left.get(j, i) || (beyond && !timeless));
        }
    }

private:
    MYRIAD_FUNCTION std::int8_t& kept_at(int j, int i) const {
        return args.side[static_cast<std::int64_t>(j) * args.size + s.instance[i]];
    }
    MYRIAD_FUNCTION bool fires_at_jump(int j, int i, const fired& events) const {
        return events.which.get(j, i) && abs(get_lane(events.value[j], i)) > args.event[j].tolerance;
    }
    MYRIAD_FUNCTION void begin_lane(int i) {
        const auto& p = inputs_of(i);
        const reals g = detail::evaluate_events<Model>(get_lane(s.now(), i), get_lanes<R>(s.data.y, i), p);
        flags at_jump;
        at_jump.clear();
        bool undefined = false;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const int kept = kept_at(j, i);
            const auto kind = static_cast<kept_side>(kept < 0 ? -kept : kept);
            const bool beyond = abs(g[j]) > args.event[j].tolerance;
            undefined = undefined || g[j] != g[j];
            at_jump.set(j, beyond && kind == kept_side::on_jump);
            e.on_jump.set(j, i, false);
            e.left.set(j, i, true);
            put_side(j, i, beyond ? sign_of(g[j]) : kind == kept_side::within ? R(kept) : R(0));
            memory_of(i).lingered[j] = 0;
        }
        set_lane(e.undefined, i, undefined);
        set_lane(e.locating, i, false);
        if (MYRIAD_UNLIKELY(at_jump.any_of())) {
            look_beyond(i, at_jump, g, s.slope_of(i));
        }
    }

    /// A time after which a jump that a step was located to is passed: longer than the rounding of t and of the state.
    MYRIAD_FUNCTION R past_jump(int i, R h_next) const {
        constexpr R fraction = std::is_same_v<R, float> ? R(0x1p-12) : R(0x1p-26);
        return fma(fraction, abs(h_next), R(64) * epsilon_of<R> * abs(get_lane(s.now(), i)));
    }
    /// The event functions a little ahead: beyond a jump which a step was located to, if the state is heading for it.
    MYRIAD_FUNCTION reals look_ahead(int i, const state& slope) const {
        const R t = get_lane(s.now(), i);
        const R ahead = copysign(past_jump(i, get_lane(s.data.h_next, i)), get_lane(s.data.t_end, i) - t);
        state y = get_lanes<R>(s.data.y, i);
        MYRIAD_UNROLL
        for (int c = 0; c < n; ++c) y[c] = fma(ahead, slope[c], y[c]);
        return detail::evaluate_events<Model>(t + ahead, y, inputs_of(i));
    }
    /// Puts functions, whose values here are g, on the side that they have there.
    MYRIAD_FUNCTION void look_beyond(int i, const flags& at_jump, const reals& g, const state& slope) {
        const reals there = look_ahead(i, slope);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            if (!at_jump[j] || !(abs(there[j]) > args.event[j].tolerance)) continue;
            put_side(j, i, sign_of(there[j]));
            if (g[j] * there[j] < R(0)) {
                e.left.set(j, i, false);
                e.on_jump.set(j, i, true);
            }
        }
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
