// SPDX-License-Identifier: MIT
// Finds events: whether an event function crossed zero in a trial step, and whether a step redone to the crossing has
// arrived there. A trial is never committed beyond a crossing.
//
// Every step looks at the functions' signs, for all lanes at once. All else is for the few lanes in which something
// happens, one by one, from values that are computed anew: what it needs costs the other steps neither time nor
// registers.
#pragma once

#include "myriad/kernel/controller/stepping.hpp"
#include "myriad/kernel/event/earliest_crossing.hpp"
#include "myriad/kernel/event/side_follower.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// What becomes of an accepted trial.
enum class trial_outcome : bool { stands, is_redone };

template <class Model, class Method, class S>
struct event_locator {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr int n = n_state<Model>;
    static constexpr int m = n_event<Model>;
    using follower = side_follower<Model, Method, S>;
    using values = vec<S, m>;  // of the event functions in all lanes
    using reals = vec<R, m>;   // in one
    using flags = mask_set<bool, m>;
    using ends_of_step = step_ends<Model, R>;
    using trial_type = trial_step<Method, S, n>;
    using fired = fired_events<Model, S>;

    follower sides;

    /// The length of the next trial of lanes that redo their step.
    MYRIAD_FUNCTION void propose_step() {
        auto& s = sides.s;
        const mask locating = sides.e.locating;
        if (!any(locating)) return;
        for_each_lane(locating, [&](int i) MYRIAD_LAMBDA { set_lane(s.h, i, sides.memory_of(i).redo.length); });
        s.final_step = s.final_step & !locating;
    }

    /// Looks at an accepted trial that ends at t1 with the event functions g1. Lanes that crossed, or stopped short of
    /// their target, are set up for a redone step and taken out of `accepted`. `events` are then those that have
    /// happened, at the end of the trial or, in lanes taken out of `accepted` as well, at its start.
    MYRIAD_FUNCTION void look(const trial_type& trial, const S& t1, const values& g1, mask& accepted, fired& events) {
        const auto& args = sides.args;
        auto& e = sides.e;
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
        busy = accepted & (busy | (sides.s.final_step & within));
        const mask follow = accepted & !busy;
        if (MYRIAD_UNLIKELY(any(busy))) {
            if constexpr (is_pack<S>) {
                // Copies, so that only they and not the caller's registers need an address.
                const trial_ends ends = ends_of(trial, t1, g1);
                mask still_accepted = accepted;
                look_out_of_line(busy, ends, still_accepted, events);
                accepted = still_accepted;
            } else {
                if (look_closer(0, ends_of(trial, t1, g1), events) == trial_outcome::is_redone) accepted = false;
            }
        }
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            e.above.set(j, (e.above[j] & !(follow & under[j])) | (follow & over[j]));
            e.left.set(j, e.left[j] | (follow & (over[j] | under[j])));
        }
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
        for_each_lane(busy, [&](int i) MYRIAD_LAMBDA {
            if (look_closer(i, ends, events) == trial_outcome::is_redone) set_lane(accepted, i, false);
        });
    }

    /// Looks at the trial of a lane in which something may have happened.
    MYRIAD_FUNCTION trial_outcome look_closer(int i, const trial_ends& ends, fired& events) {
        const auto& args = sides.args;
        auto& s = sides.s;
        auto& e = sides.e;
        const auto& p = sides.inputs_of(i);
        ends_of_step step(p);
        step.t = get_lane(s.now(), i);
        step.h = get_lane(s.h, i);
        step.t1 = get_lane(ends.t1, i);
        step.y = get_lanes<R>(s.data.y, i);
        step.y1 = get_lanes<R>(ends.y, i);
        step.slope = get_lanes<R>(ends.slope_start, i);
        step.g = detail::evaluate_events<Model>(step.t, step.y, p);
        // Not those of the pack, which may round otherwise than what they are compared with.
        step.g1 = is_pack<S> ? detail::evaluate_events<Model>(step.t1, step.y1, p) : get_lanes<R>(ends.g, i);
        sides.settle_open_sides(i, step);

        const bool locating = get_lane(e.locating, i), final_step = get_lane(s.final_step, i);
        const bool scans = args.sub_samples > 1;
        reals side;
        flags crossed;
        crossed.clear();
        bool within = false;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            side[j] = sides.side_of(j, i);
            within = within || abs(step.g1[j]) <= args.event[j].tolerance;
            if (e.on_jump.get(j, i)) step.g[j] = copysign(R(infinity_of<R>), side[j]);
            crossed.set(j, sides.crosses(j, side[j], step.g1[j]) && !sides.is_at_jump(j, i, step.h));
        }
        if (crossed.any_of() || locating || scans || (final_step && within)) {
            if constexpr (Method::first_same_as_last) {
                step.slope1 = get_lanes<R>(ends.slope_end, i);
            } else {
                step.slope1 = detail::evaluate_rhs<Model>(step.t1, step.y1, p);
                add_to_count(s.extra_evaluations, i);
            }
            R low = R(0), high = R(1);
            if (scans) crossed = scan(i, step, side, low, high);
            if (crossed.any_of()) {
                begin_or_shorten(i, step, side, crossed, low, high, events);
                return trial_outcome::is_redone;
            }
            if (locating) {
                if (arrive(i, step, side, events) == trial_outcome::is_redone) return trial_outcome::is_redone;
            } else if (final_step && within) {
                end_on_root(i, step, side, events);
            }
        }
        sides.follow(i, step, side);
        return trial_outcome::stands;
    }

    /// Looks at `sub_samples` points of the step for the first that shows a crossing, follows the sides up to there,
    /// and makes [low, high] the part of the step that holds it.
    MYRIAD_FUNCTION flags scan(int i, const ends_of_step& step, reals& side, R& low, R& high) {
        const auto& args = sides.args;
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
                crossed.set(j, sides.crosses(j, side[j], g[j]) && !sides.is_at_jump(j, i, length));
            if (crossed.any_of()) {
                high = theta;
                break;
            }
            if (!last) low = theta;
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j) {
                if (!(abs(g[j]) > args.event[j].tolerance) || sides.is_at_jump(j, i, length)) continue;
                side[j] = sign_of(g[j]);
                if (!sides.is_timeless(i, length) && !e.on_jump.get(j, i)) e.left.set(j, i, true);
            }
        }
        return crossed;
    }

    /// Sets up a lane whose trial crossed: a step redone to the crossing, or the event at the start of the step.
    MYRIAD_FUNCTION void begin_or_shorten(int i, const ends_of_step& step, const reals& side, const flags& crossed,
                                          R low, R high, fired& events) {
        const auto& args = sides.args;
        auto& s = sides.s;
        auto& redo = sides.memory_of(i).redo;
        const bool again = get_lane(sides.e.locating, i);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const bool undecided = again && redo.crossed[j] && abs(step.g1[j]) <= args.event[j].tolerance;
            redo.crossed.set(j, crossed[j] || undecided);
        }
        located_crossing<R> first;
        if (MYRIAD_UNLIKELY(args.sub_samples > 1 && !again)) {
            first = detail::earliest_crossing_between(low, high, step, crossed, args.event);
        } else {
            first = detail::earliest_crossing(step, side, crossed, args.event);
        }
        redo.target = first.event;
        const R guess = step.h * first.fraction;
        if (again) {
            redo.shorten(step.h, guess);
        } else {
            redo.begin(step.h, guess, get_lane(s.data.h_next, i));
        }
        add_to_count(s.located, i);
        const bool here = redo.length == R(0);
        set_lane(sides.e.locating, i, !here);
        if (!here) return;
        const reals slope = step.slopes();
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const bool near = abs(step.g[j]) <= args.event[j].tolerance;
            const bool happens = redo.target == j || (redo.crossed[j] && (near || redo.narrow));
            events.put(j, i, happens, step.g[j], slope[j]);
        }
        stepping<Model, Method, S>{args, s}.resume(i, redo.resume);
    }

    /// A redone step that ended before its crossing: within the tolerance its events have happened; else it goes
    /// further.
    MYRIAD_FUNCTION trial_outcome arrive(int i, const ends_of_step& step, const reals& side, fired& events) {
        const auto& args = sides.args;
        auto& e = sides.e;
        auto& redo = sides.memory_of(i).redo;
        const reals slope = step.slopes1();
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
            add_to_count(sides.s.located, i);
            return trial_outcome::is_redone;
        }
        reals middle = step.g1;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            if (!e.left.get(j, i)) {
                middle = step.values_at(R(0.5));
                break;
            }
        }
        const bool timeless = sides.is_timeless(i, step.h);
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
        stepping<Model, Method, S>{args, sides.s}.resume(i, redo.resume);
        return trial_outcome::stands;
    }

    /// Functions within their tolerance and on their way across where the domain ends: their events happen there if
    /// they are past zero, or short of it by rounding alone, both by the slope and by the last step: a function that
    /// settles at zero, or is still falling towards it, comes there later or never.
    MYRIAD_FUNCTION void end_on_root(int i, const ends_of_step& step, const reals& side, fired& events) {
        const reals slope = step.slopes1();
        const R rounding = end_rounding(i, step);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const R g = side[j] * step.g1[j], speed = -side[j] * slope[j] * sign_of(step.h);  // towards zero
            const R last_speed = (side[j] * step.g[j] - g) / abs(step.h);
            const bool at_zero = g <= R(0) || g <= (speed < last_speed ? speed : last_speed) * rounding;
            const bool near = abs(g) <= sides.args.event[j].tolerance;
            events.put(j, i, sides.is_asked(j, side[j]) && near && speed > R(0) && at_zero, step.g1[j], slope[j]);
        }
    }

    /// What the rounding of the phase's steps may have put between the end of the domain and a crossing there, in time;
    /// not more than a small part of a step, from which on it cannot be told from a slow approach.
    MYRIAD_FUNCTION R end_rounding(int i, const ends_of_step& step) const {
        const auto& args = sides.args;
        const auto& s = sides.s;
        const R t_begin = args.t_begin != nullptr ? args.t_begin[s.instance[i]] : args.common_t_begin;
        const R steps = static_cast<R>(s.iteration - s.phase_start[i]);
        const R rounding = R(2) * epsilon_of<R> * steps * max(abs(step.t1), abs(t_begin));
        return min(rounding, R(1.0 / 64) * abs(step.h));
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
