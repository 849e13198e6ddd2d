// SPDX-License-Identifier: MIT
// Finds events: which functions crossed zero in a trial step, where in it, and whether a step redone to there has
// arrived. A trial is never committed beyond a crossing.
//
// A crossing is a change of side: the side an event function was last seen on, beyond its tolerance, is remembered, so
// a function that lingers within the tolerance neither fires twice nor is lost, and one that only touches zero does not
// fire. Where a step starts within the tolerance, the slope of the function along the solution (by dual numbers) tells
// where it is heading, and a root at the start is divided out, so that a short flight after an impact is not missed.
//
// Every step looks at the functions' signs, for all lanes at once. All else is for the few lanes in which something
// happens, one by one, from values that are computed anew: what it needs costs the other steps neither time nor
// registers.
#pragma once

#include "myriad/kernel/event/crossing.hpp"
#include "myriad/kernel/event/event_functions.hpp"
#include "myriad/kernel/event/event_sides.hpp"
#include "myriad/kernel/event/redone_step.hpp"
#include "myriad/kernel/state/integration_state.hpp"
#include "myriad/kernel/stepper/dense_output.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The events that have happened where a trial ended, or where it began in lanes whose trial was not accepted.
template <class Model, class S>
struct fired_events {
    mask_set<mask_of<S>, n_event<Model>> which;
    vec<S, n_event<Model>> value;  // of all event functions there
    vec<S, n_event<Model>> slope;  // along the solution, before the actions
    mask_of<S> changed;            // lanes in which a hook has since changed what event functions depend on

    /// Whether event j happens in lane i, where its function has this value and slope.
    MYRIAD_FUNCTION void put(int j, int i, bool happens, real_of<S> g, real_of<S> g_slope) {
        which.set(j, i, happens);
        set_lane(value[j], i, g);
        set_lane(slope[j], i, g_slope);
    }
    /// No event; values that nobody reads any more take no registers from here on.
    MYRIAD_FUNCTION void clear() {
        which.clear();
        changed = mask_of<S>(false);
        MYRIAD_UNROLL
        for (int j = 0; j < n_event<Model>; ++j) value[j] = slope[j] = S(real_of<S>(0));
    }
};

/// What the location of events keeps of one instance from step to step, in memory.
template <class Model, class R>
struct event_memory {
    redone_step<R, n_event<Model>> redo;
    vec<std::int32_t, n_event<Model>> lingered;  // times that an event fired in a row without its function having left
};

/// Follows the events of a pack.
template <class Model, class Method, class S>
struct event_locator {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr int n = n_state<Model>;
    static constexpr int m = n_event<Model>;
    using values = vec<S, m>;  // of the event functions in all lanes
    using reals = vec<R, m>;   // in one
    using flags = mask_set<bool, m>;
    using state = vec<R, n>;
    using trial_type = trial_step<Method, S, n>;
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

    /// The length of the next trial of lanes that redo their step.
    MYRIAD_FUNCTION void propose_step() {
        if (!any(e.locating)) return;
        for_each_lane(e.locating, [&](int i) MYRIAD_LAMBDA { set_lane(s.h, i, memory_of(i).redo.length); });
        s.final_step = s.final_step & !e.locating;
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

    /// Looks at an accepted trial that ends at t1 with the event functions g1. Lanes that crossed, or stopped short of
    /// their target, are set up for a redone step and taken out of `accepted`. Returns the events that have happened,
    /// at the end of the trial or, in lanes taken out of `accepted` as well, at its start.
    MYRIAD_FUNCTION void look(const trial_type& trial, const S& t1, const values& g1, mask& accepted, fired& events) {
        e.locating = e.locating & accepted;  // a trial that failed its error test takes the next one's length
        if constexpr (is_pack<S>) {
            events.which.clear();  // a pack's values lie in memory
            events.changed = mask(false);
        } else {
            events.clear();
        }
        mask busy = e.locating | e.open.any_of() | e.on_jump.any_of() | mask(args.sub_samples > 1);
        mask within = mask(false);
        vec<mask, m> over, under;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            over[j] = g1[j] > S(args.event[j].tolerance);
            under[j] = g1[j] < S(-args.event[j].tolerance);
            const mask above = e.above[j], below = !above;
            busy = busy | (above & under[j] & mask(args.event[j].falling)) |
                   (below & over[j] & mask(args.event[j].rising));
            within = within | !(over[j] | under[j]);
        }
        busy = accepted & (busy | (s.final_step & within));
        const mask follow = accepted & !busy;
        if (MYRIAD_UNLIKELY(any(busy))) {
            if constexpr (is_pack<S>) {
                // Copies, so that only they and not the caller's registers need an address.
                const trial_ends ends = ends_of(trial, t1, g1);
                mask still_accepted = accepted;
                look_out_of_line(busy, ends, still_accepted, events);
                accepted = still_accepted;
            } else {
                look_closer(0, ends_of(trial, t1, g1), accepted, events);
            }
        }
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            e.above.set(j, (e.above[j] & !(follow & under[j])) | (follow & over[j]));
            e.left.set(j, e.left[j] | (follow & (over[j] | under[j])));
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

private:
    /// A trial's ends, in all lanes.
    struct trial_ends {
        S t1;
        vec<S, n> y, slope_start, slope_end;  // slope_end only of methods that know it
        values g;
    };
    MYRIAD_FUNCTION trial_ends ends_of(const trial_type& trial, const S& t1, const values& g1) const {
        trial_ends ends{t1, trial.y, trial.k[0], {}, g1};
        if constexpr (Method::first_same_as_last) ends.slope_end = trial.slope_end();
        return ends;
    }
    [[gnu::noinline]] void look_out_of_line(const mask& busy, const trial_ends& ends, mask& accepted, fired& events) {
        for_each_lane(busy, [&](int i) MYRIAD_LAMBDA { look_closer(i, ends, accepted, events); });
    }

    /// A trial step of one instance, from one end to the other.
    struct step_ends {
        R t, h, t1;
        state y, y1, slope, slope1;
        reals g, g1;  // the event functions
    };

    MYRIAD_FUNCTION std::int8_t& kept_at(int j, int i) const {
        return args.side[static_cast<std::int64_t>(j) * args.size + s.instance[i]];
    }
    /// What the event functions of lane i read beside t and y.
    MYRIAD_FUNCTION decltype(auto) inputs_of(int i) const {
        if constexpr (lanes_of<S> == 1) {
            return static_cast<const inputs<Model, S>&>(s.data);
        } else {
            return detail::extract_lane(s.data, i);
        }
    }
    static MYRIAD_FUNCTION R sign_of(R x) { return x > R(0) ? R(1) : x < R(0) ? R(-1) : R(0); }
    /// +1, -1, or 0 where the side is not yet known.
    MYRIAD_FUNCTION R side_of(int j, int i) const { return e.open.get(j, i) ? R(0) : e.above.get(j, i) ? R(1) : R(-1); }
    MYRIAD_FUNCTION void put_side(int j, int i, R side) {
        e.open.set(j, i, side == R(0));
        e.above.set(j, i, side > R(0));
    }
    MYRIAD_FUNCTION bool fires_at_jump(int j, int i, const fired& events) const {
        return events.which.get(j, i) && abs(get_lane(events.value[j], i)) > args.event[j].tolerance;
    }
    /// Whether event j is to fire where its function crosses from the given side.
    MYRIAD_FUNCTION bool is_asked(int j, R side) const {
        return (side > R(0) && args.event[j].falling) || (side < R(0) && args.event[j].rising);
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

    /// Looks at the trial of a lane in which something may have happened.
    MYRIAD_FUNCTION void look_closer(int i, const trial_ends& ends, mask& accepted, fired& events) {
        const auto& p = inputs_of(i);
        step_ends step;
        step.t = get_lane(s.now(), i);
        step.h = get_lane(s.h, i);
        step.t1 = get_lane(ends.t1, i);
        step.y = get_lanes<R>(s.data.y, i);
        step.y1 = get_lanes<R>(ends.y, i);
        step.slope = get_lanes<R>(ends.slope_start, i);
        step.g = detail::evaluate_events<Model>(step.t, step.y, p);
        // Not those of the pack, which may round otherwise than what they are compared with.
        step.g1 = is_pack<S> ? detail::evaluate_events<Model>(step.t1, step.y1, p) : get_lanes<R>(ends.g, i);
        settle_open_sides(i, step, p);

        const bool locating = get_lane(e.locating, i), final_step = get_lane(s.final_step, i),
                   scans = args.sub_samples > 1;
        reals side;
        flags crossed;
        crossed.clear();
        bool within = false;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            side[j] = side_of(j, i);
            within = within || abs(step.g1[j]) <= args.event[j].tolerance;
            if (e.on_jump.get(j, i)) step.g[j] = copysign(R(infinity_of<R>), side[j]);
            crossed.set(j, crosses(j, side[j], step.g1[j]) && !is_at_jump(j, i, step.h));
        }
        if (crossed.any_of() || locating || scans || (final_step && within)) {
            if constexpr (Method::first_same_as_last) {
                step.slope1 = get_lanes<R>(ends.slope_end, i);
            } else {
                step.slope1 = detail::evaluate_rhs<Model>(step.t1, step.y1, p);
                add_to_count(s.extra_evaluations, i);
            }
            R low = R(0), high = R(1);
            if (scans) crossed = scan(i, step, side, low, high, p);
            if (crossed.any_of()) {
                begin_or_shorten(i, step, side, crossed, low, high, events, p);
                set_lane(accepted, i, false);
                return;
            }
            if (locating) {
                if (!arrive(i, step, side, events, p)) {
                    set_lane(accepted, i, false);
                    return;
                }
            } else if (final_step && within) {
                end_on_root(i, step, side, events, p);
            }
        }
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

    MYRIAD_FUNCTION bool crosses(int j, R side, R g) const {
        return is_asked(j, side) && side * g < -args.event[j].tolerance;
    }

    /// Settles sides that are open by where the functions are heading.
    MYRIAD_FUNCTION void settle_open_sides(int i, const step_ends& step, const inputs<Model, R>& p) {
        bool open = false;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) open = open || e.open.get(j, i);
        if (!open) return;
        const reals slope = detail::event_slopes<Model>(step.t, step.y, step.slope, p);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j)
            if (e.open.get(j, i)) put_side(j, i, sign_of(slope[j]) * sign_of(step.h));
    }

    /// The event functions inside a step, of the cubic through its ends.
    MYRIAD_FUNCTION reals values_at(const step_ends& step, R theta, const inputs<Model, R>& p) const {
        const state y = detail::hermite_interpolation(step.y, step.y1, step.slope, step.slope1, step.h, theta);
        return detail::evaluate_events<Model>(fma(theta, step.h, step.t), y, p);
    }

    /// Looks at `sub_samples` points of the step for the first that shows a crossing, follows the sides up to there,
    /// and makes [low, high] the part of the step that holds it.
    MYRIAD_FUNCTION flags scan(int i, const step_ends& step, reals& side, R& low, R& high, const inputs<Model, R>& p) {
        flags crossed;
        crossed.clear();
        MYRIAD_ROLLED
        for (int k = 1; k <= args.sub_samples; ++k) {
            const bool last = k == args.sub_samples;
            const R theta = static_cast<R>(k) / static_cast<R>(args.sub_samples), length = theta * step.h;
            const reals g = last ? step.g1 : values_at(step, theta, p);
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j) crossed.set(j, crosses(j, side[j], g[j]) && !is_at_jump(j, i, length));
            if (crossed.any_of()) {
                high = theta;
                break;
            }
            if (!last) low = theta;
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j) {
                if (!(abs(g[j]) > args.event[j].tolerance) || is_at_jump(j, i, length)) continue;
                side[j] = sign_of(g[j]);
                if (!is_timeless(i, length) && !e.on_jump.get(j, i)) e.left.set(j, i, true);
            }
        }
        return crossed;
    }

    /// The earliest of a step's crossings, as a fraction of the step; sets the target.
    MYRIAD_FUNCTION R earliest(const step_ends& step, const reals& side, const flags& crossed, std::int32_t& target,
                               const inputs<Model, R>& p) const {
        const reals d = detail::event_slopes<Model>(step.t, step.y, step.slope, p);
        const reals d1 = detail::event_slopes<Model>(step.t1, step.y1, step.slope1, p);
        R first = R(2);
        target = 0;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            if (!crossed[j]) continue;
            const R per_step = side[j] * step.h;
            const function_ends<R> g{side[j] * step.g[j], per_step * d[j], side[j] * step.g1[j], per_step * d1[j]};
            const bool on_surface = !(g.value > args.event[j].tolerance);
            R x = R(0);
            if (!on_surface || g.slope > R(0))
                x = detail::crossing_fraction(g, on_surface, R(0.01) * args.event[j].tolerance);
            if (x < first) {
                first = x;
                target = j;
            }
        }
        return first;
    }
    /// The same of crossings between the samples at the fractions `low` and `high` of a step, by the secants between
    /// them.
    MYRIAD_FUNCTION R earliest_between(const step_ends& step, const flags& crossed, R low, R high, std::int32_t& target,
                                       const inputs<Model, R>& p) const {
        const reals g = values_at(step, low, p), g1 = high < R(1) ? values_at(step, high, p) : step.g1;
        R first = R(2);
        target = 0;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            if (!crossed[j]) continue;
            // A function within its tolerance there may be about to leave it, and to come back.
            const bool within = abs(g[j]) <= args.event[j].tolerance;
            const R part = within ? R(0.5) : g[j] / (g[j] - g1[j]);
            const R x = fma(high - low, part, low);
            if (x < first) {
                first = x;
                target = j;
            }
        }
        return first;
    }

    /// Sets up a lane whose trial crossed: a step redone to the crossing, or the event at the start of the step.
    MYRIAD_FUNCTION void begin_or_shorten(int i, const step_ends& step, const reals& side, const flags& crossed, R low,
                                          R high, fired& events, const inputs<Model, R>& p) {
        auto& redo = memory_of(i).redo;
        const bool again = get_lane(e.locating, i);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const bool undecided = again && redo.crossed[j] && abs(step.g1[j]) <= args.event[j].tolerance;
            redo.crossed.set(j, crossed[j] || undecided);
        }
        R guess = step.h;
        if (MYRIAD_UNLIKELY(args.sub_samples > 1 && !again)) {
            guess *= earliest_between(step, crossed, low, high, redo.target, p);
        } else {
            guess *= earliest(step, side, crossed, redo.target, p);
        }
        if (again) {
            redo.shorten(step.h, guess);
        } else {
            redo.begin(step.h, guess, get_lane(s.data.h_next, i));
        }
        add_to_count(s.located, i);
        const bool here = redo.length == R(0);
        set_lane(e.locating, i, !here);
        if (!here) return;
        const reals slope = detail::event_slopes<Model>(step.t, step.y, step.slope, p);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const bool near = abs(step.g[j]) <= args.event[j].tolerance;
            const bool happens = redo.target == j || (redo.crossed[j] && (near || redo.narrow));
            events.put(j, i, happens, step.g[j], slope[j]);
        }
        if constexpr (is_adaptive<Method>) set_lane(s.data.h_next, i, redo.resume);
    }

    /// A redone step that ended before its crossing: within the tolerance its events have happened; else it goes
    /// further, and false is returned.
    MYRIAD_FUNCTION bool arrive(int i, const step_ends& step, const reals& side, fired& events,
                                const inputs<Model, R>& p) {
        auto& redo = memory_of(i).redo;
        const reals slope = detail::event_slopes<Model>(step.t1, step.y1, step.slope1, p);
        R gap = R(0), approach = R(0), tolerance = R(0);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            if (redo.target != j) continue;
            gap = side[j] * step.g1[j];
            approach = side[j] * slope[j];
            tolerance = args.event[j].tolerance;
        }
        const R guess = step.h - gap * reciprocal(approach);
        const bool narrow = redo.is_between(step.h);
        bool further = gap > tolerance && !narrow && redo.tries < redo.most_trials;
        if (further) {
            redo.lengthen(step.h, guess);
        } else {
            further = abs(gap) <= tolerance && abs(gap) > R(0.1) * tolerance && redo.improve(step.h, guess, gap > R(0));
        }
        if (further) {
            add_to_count(s.located, i);
            return false;
        }
        reals middle = step.g1;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            if (!e.left.get(j, i)) {
                middle = values_at(step, R(0.5), p);
                break;
            }
        }
        const bool timeless = is_timeless(i, step.h);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const R near = args.event[j].tolerance;
            const bool heads = abs(step.g1[j]) <= near && side[j] * slope[j] * step.h < R(0);
            const bool jumps = narrow && side[j] * step.g1[j] > near;
            const bool happens = redo.target == j || (redo.crossed[j] && (heads || jumps));
            events.put(j, i, happens, step.g1[j], slope[j]);
            if (!timeless && !e.on_jump.get(j, i) && abs(middle[j]) > near) e.left.set(j, i, true);
        }
        set_lane(e.locating, i, false);
        if constexpr (is_adaptive<Method>) set_lane(s.data.h_next, i, redo.resume);
        return true;
    }

    /// Functions within their tolerance and on their way across where the domain ends: their events happen there if
    /// they are past zero, or short of it by rounding alone, both by the slope and by the last step: a function that
    /// settles at zero, or is still falling towards it, comes there later or never.
    MYRIAD_FUNCTION void end_on_root(int i, const step_ends& step, const reals& side, fired& events,
                                     const inputs<Model, R>& p) {
        const reals slope = detail::event_slopes<Model>(step.t1, step.y1, step.slope1, p);
        const R rounding = end_rounding(i, step);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const R g = side[j] * step.g1[j], speed = -side[j] * slope[j] * sign_of(step.h);  // towards zero
            const R last_speed = (side[j] * step.g[j] - g) / abs(step.h);
            const bool at_zero = g <= R(0) || g <= (speed < last_speed ? speed : last_speed) * rounding;
            const bool happens = is_asked(j, side[j]) && abs(g) <= args.event[j].tolerance && speed > R(0) && at_zero;
            events.put(j, i, happens, step.g1[j], slope[j]);
        }
    }

    /// What the rounding of the phase's steps may have put between the end of the domain and a crossing there, in time;
    /// not more than a small part of a step, from which on it cannot be told from a slow approach.
    MYRIAD_FUNCTION R end_rounding(int i, const step_ends& step) const {
        const R t_begin = args.t_begin != nullptr ? args.t_begin[s.instance[i]] : args.common_t_begin;
        const R steps = static_cast<R>(s.iteration - s.phase_start[i]);
        const R rounding = R(2) * epsilon_of<R> * steps * max(abs(step.t1), abs(t_begin));
        return min(rounding, R(1.0 / 64) * abs(step.h));
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
