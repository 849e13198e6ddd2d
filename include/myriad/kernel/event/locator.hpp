// SPDX-License-Identifier: MIT
// Locates events: whether the trial of a lane crossed, and the step redone until it ends at the crossing. No trial is
// committed beyond a crossing.
//
// It works on one lane at a time, only where something happens, from recomputed values, so that it costs ordinary steps
// neither time nor registers.
#pragma once

#include "myriad/kernel/controller/stepping.hpp"
#include "myriad/kernel/event/earliest_crossing.hpp"
#include "myriad/kernel/event/event_nearness.hpp"
#include "myriad/kernel/event/event_sight.hpp"
#include "myriad/kernel/event/side_follower.hpp"

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

template <class Model, class Method, class S>
struct event_locator {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr int m = n_event<Model>;
    using reals = vec<R, m>;  // of the event functions in one lane
    using flags = mask_set<bool, m>;
    using ends_of_step = step_ends<Model, R>;
    using fired = fired_events<Model, S>;

    side_follower<Model, Method, S> sides;

    /// Sets the length of the next trial in lanes that redo their step.
    MYRIAD_FUNCTION void propose_step() {
        auto& s = sides.s;
        const mask in_question = sides.e.flags[sides.e.in_question];
        if (!MYRIAD_UNLIKELY(any(in_question))) return;
        for_each_lane(in_question, [&](int i) MYRIAD_LAMBDA {
            const auto& own = sides.memory_of(i);
            if (!own.locating) return;
            set_lane(s.h, i, own.redo.length);
            set_lane(s.final_step, i, false);
        });
    }
    /// Those of the lanes that may be ended if their step does not advance t: a flight between events may be shorter
    /// than the resolution of t.
    MYRIAD_FUNCTION mask may_stick(mask lanes) const {
        for_each_lane(lanes & sides.e.flags[sides.e.in_question], [&](int i) MYRIAD_LAMBDA {
            if (sides.memory_of(i).locating) set_lane(lanes, i, false);
        });
        return lanes;
    }

    /// Checks the trial of one lane in which an event may have fired.
    MYRIAD_FUNCTION trial_outcome look_closer(int i, const trial_ends<Model, S>& ends, const event_sight<S, m>& seen,
                                              fired& events) {
        const auto& p = sides.inputs_of(i);
        ends_of_step step(p);
        step.t = get_lane(sides.s.now(), i);
        step.h = get_lane(sides.s.h, i);
        step.t1 = get_lane(ends.t1, i);
        step.y = get_lanes<R>(sides.s.data.y, i);
        step.y1 = get_lanes<R>(ends.y, i);
        step.slope = get_lanes<R>(ends.slope_start, i);
        if constexpr (!is_pack<S>) {
            step.g1 = ends.g;
            flags crossed = seen.crossed & sides.asked();
            if (is_plain(i, step, crossed)) return look_plainly(i, step, ends, crossed, events);
        } else {
            // Not the pack's values, which may round differently from those they are compared with.
            step.g1 = detail::evaluate_events<Model>(step.t1, step.y1, p);
        }
        return look_carefully(i, step, ends, events);
    }

    /// A redone step that failed its error test is not redone: the controller sets the length of the next.
    MYRIAD_FUNCTION void give_up(int i) {
        sides.memory_of(i).locating = false;
        sides.note(i);
    }

    /// Looks closer at all of these lanes whose trial is accepted, and gives up in the others. Lanes whose step is
    /// redone are removed from `accepted`.
    __attribute__((noinline)) void look_out_of_line(const mask& busy, const trial_ends<Model, S>& ends,
                                                    const event_sight<S, m>& seen, mask& accepted, fired& events) {
        for_each_lane(busy, [&](int i) MYRIAD_LAMBDA {
            if (!get_lane(accepted, i)) return give_up(i);
            if (look_closer(i, ends, seen, events) == trial_outcome::is_redone) set_lane(accepted, i, false);
        });
    }

private:
    /// The part of a step, in fractions of it, that contains the crossings.
    struct step_part {
        R low = R(0), high = R(1);
        bool scanned = false;  // found by a look at points inside the step, and the slope at its end is known
    };

    /// Whether a trial does what nearly all do that are looked at: one function, of those in `crossed`, has crossed, or
    /// the step ends close to its event. That can be told without the rounding errors of the event functions if these
    /// are smaller than tolerances that were given: every function has a side and is beyond its tolerance, or at the
    /// event. One that has not left its surface since its event must be on the side that it was heading for.
    MYRIAD_FUNCTION bool is_plain(int i, const ends_of_step& step, flags& crossed) const {
        const auto& own = sides.memory_of(i);
        bool plain = sides.args.sub_samples <= 1 && !(own.open | own.on_jump).any_of();
        bool arrives = false, others = false;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const R tolerance = sides.args.event[j].tolerance, g = abs(step.g1[j]);
            const bool left = sides.e.left.get(j, i), stays = (step.g1[j] > R(0)) == sides.e.above.get(j, i);
            const bool is_target = own.redo.target == j;
            const bool here = own.locating && is_target && left && g <= R(arrival_part) * own.redo.tolerance[j];
            plain = plain && tolerance > R(0) && (here || (g > tolerance && (left || stays)));
            arrives = arrives || here;
            others = others || !left || (!is_target && own.redo.crossed[j]);
            if (here) crossed.set(j, false);
        }
        return plain && (crossed.any_of() ? !crossed.several() : arrives && !others);
    }
    /// Looks at a trial for which `is_plain` holds.
    MYRIAD_FUNCTION trial_outcome look_plainly(int i, ends_of_step& step, const trial_ends<Model, S>& ends,
                                               const flags& crossed, fired& events) {
        auto& own = sides.memory_of(i);
        if (crossed.any_of()) {
            reals side;
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j) side[j] = sides.e.above.get(j, i) ? R(1) : R(-1);
            step.g = detail::evaluate_events<Model>(step.t, step.y, step.p);
            know_end_slope(i, step, ends);
            begin_or_shorten(i, step, side, crossed, step_part{}, plain_nearness<Model, R>{sides.args}, events);
            return trial_outcome::is_redone;
        }
        own.at_jump.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) events.put(j, i, own.redo.target == j, step.g1[j]);
        end_location(i);
        return trial_outcome::stands_before_sides;
    }
    /// Looks at any trial, with the rounding errors of the event functions.
    MYRIAD_FUNCTION trial_outcome look_carefully(int i, ends_of_step& step, const trial_ends<Model, S>& ends,
                                                 fired& events) {
        auto& own = sides.memory_of(i);
        auto& near = own.near;
        step.g = detail::evaluate_events<Model>(step.t, step.y, step.p);
        near.roundings = step.roundings();
        sides.settle_open_sides(i, step, near.roundings);
        reals side;
        flags crossed;
        crossed.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            side[j] = sides.side_of(j, i);
            // Only as far as it was on the other side at the start may a function be there without having crossed.
            const R start = own.on_jump[j] ? R(0) : -side[j] * step.g[j];
            const R tolerance = own.locating ? own.redo.tolerance[j] : sides.args.event[j].tolerance;
            near.floors[j] = max(near.roundings[j], start);
            near.bands[j] = max(tolerance, near.floors[j]);
            const bool located = own.locating && (own.redo.target == j || own.redo.crossed[j]);
            near.pasts[j] = located ? near.bands[j] : near.floors[j];
            crossed.set(j, sides.crosses(j, side[j], step.g1[j], near.past(j)) && !sides.is_at_jump(j, i, step.h));
        }
        step_part part;
        if (MYRIAD_UNLIKELY(sides.args.sub_samples > 1)) {
            know_end_slope(i, step, ends);
            part.scanned = true;
            crossed = scan(i, step, side, part);
        }
        const bool locating = own.locating;
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
            know_end_slope(i, step, ends);
        if (crossed.any_of()) {
            know_start(i, step, side);
            begin_or_shorten(i, step, side, crossed, part, near, events);
            return trial_outcome::is_redone;
        }
        if (locating) {
            if (arrive(i, step, side, reached, events) == trial_outcome::is_redone) return trial_outcome::is_redone;
        } else if (is_last) {
            know_start(i, step, side);
            end_on_root(i, step, side, events);
        }
        sides.follow(i, step, side);
        sides.note(i);
        return trial_outcome::stands;
    }

    /// Whether an event may happen at the end of the domain.
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

    /// The event to which the step was redone is reached.
    MYRIAD_FUNCTION void end_location(int i) {
        sides.memory_of(i).locating = false;
        sides.note(i);
        stepping<Model, Method, S>{sides.args, sides.s}.resume(i, sides.memory_of(i).redo.resume);
    }

    MYRIAD_FUNCTION void know_end_slope(int i, ends_of_step& step, const trial_ends<Model, S>& ends) {
        if constexpr (Method::first_same_as_last) {
            step.slope1 = get_lanes<R>(ends.slope_end, i);
        } else {
            step.slope1 = detail::evaluate_rhs<Model>(step.t1, step.y1, step.p);
            add_to_count(sides.s.extra_evaluations, i);
        }
    }
    /// Evaluates the event functions at the start of the step. A function at a jump that no step has passed yet counts
    /// as infinite.
    MYRIAD_FUNCTION void know_start(int i, ends_of_step& step, const reals& side) const {
        step.g = detail::evaluate_events<Model>(step.t, step.y, step.p);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j)
            if (sides.memory_of(i).on_jump[j]) step.g[j] = copysign(R(infinity_of<R>), side[j]);
    }
    /// Checks `sub_samples` points of the step for the first crossing, updates the sides up to it, and sets `part` to
    /// the part of the step that contains it.
    MYRIAD_FUNCTION flags scan(int i, const ends_of_step& step, reals& side, step_part& part) {
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

    /// Sets up a lane whose trial crossed: either a redone step, or an event at the start of the step.
    template <class Nearness>
    MYRIAD_FUNCTION void begin_or_shorten(int i, const ends_of_step& step, const reals& side, const flags& crossed,
                                          const step_part& part, const Nearness& near, fired& events) {
        const auto& args = sides.args;
        auto& s = sides.s;
        auto& own = sides.memory_of(i);
        auto& redo = own.redo;
        const bool again = own.locating;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const bool undecided = again && redo.crossed[j] && abs(step.g1[j]) <= near.band(j);
            redo.crossed.set(j, crossed[j] || undecided);
            if (again) continue;
            const R change = abs(step.g1[j] - step.g[j]);
            redo.tolerance[j] = min(args.event[j].tolerance, R(largest_part) * change);
        }
        located_crossing<R> first;
        if (MYRIAD_UNLIKELY(part.scanned && !again)) {
            first = detail::earliest_crossing_between(part.low, part.high, step, crossed);
        } else if constexpr (Nearness::is_plain) {
            first = detail::only_crossing(step, side, crossed, near, redo.tolerance);
        } else {
            first = detail::earliest_crossing(step, side, crossed, near, redo.tolerance);
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
        own.locating = !here;
        sides.note(i);
        if (!here) return;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const bool close = abs(step.g[j]) <= max(redo.tolerance[j], near.floor(j));
            const bool happens = redo.target == j || (redo.crossed[j] && (close || redo.narrow));
            events.put(j, i, happens, step.g[j]);
            own.at_jump.set(j, happens && !close);
        }
        stepping<Model, Method, S>{args, s}.resume(i, redo.resume);
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
                                         fired& events) {
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
                add_to_count(sides.s.located, i);
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
        end_location(i);
        return trial_outcome::stands;
    }

    /// Events at the end of the domain: a function moving towards zero fires if it is at or past zero, or short of it
    /// by rounding alone, judged by both its slope and the last step. A function that settles at zero, or is still
    /// falling towards it, gets there later or never; one that is about to turn back, as at a double root, does not
    /// cross it.
    MYRIAD_FUNCTION void end_on_root(int i, const ends_of_step& step, const reals& side, fired& events) {
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

    /// A bound on the time between the end of the domain and a crossing that the phase's rounding errors may have
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
