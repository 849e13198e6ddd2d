// SPDX-License-Identifier: MIT
// Locates events: whether the trial of a lane crossed, and the step redone until it ends at the crossing. No trial is
// committed beyond a crossing.
//
// It works on one lane at a time, only where something happens, from recomputed values, so that it costs ordinary steps
// neither time nor registers.
#pragma once

#include "myriad/kernel/controller/stepping.hpp"
#include "myriad/kernel/event/earliest_crossing.hpp"
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
        const bool scans = args.sub_samples > 1;
        bool sides_are_known = false;
        if constexpr (!is_pack<S>) {
            const auto& own = sides.memory_of(i);
            sides_are_known = !scans && !(own.open | own.on_jump).any_of();
        }
        reals side;
        flags crossed;
        bool within = false;
        if (sides_are_known) {
            if constexpr (!is_pack<S>) {
                step.g1 = ends.g;
                crossed = seen.crossed & sides.asked();
                within = !seen.beyond.all_of();
            }
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j) side[j] = e.above.get(j, i) ? R(1) : R(-1);
        } else {
            // Not the pack's values, which may round differently from those they are compared with.
            step.g1 = is_pack<S> ? detail::evaluate_events<Model>(step.t1, step.y1, p) : get_lanes<R>(ends.g, i);
            sides.settle_open_sides(i, step);
            crossed.clear();
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j) {
                side[j] = sides.side_of(j, i);
                within = within || abs(step.g1[j]) <= args.event[j].tolerance;
                crossed.set(j, sides.crosses(j, side[j], step.g1[j]) && !sides.is_at_jump(j, i, step.h));
            }
        }
        const bool locating = sides.memory_of(i).locating, is_last = get_lane(s.final_step, i) && within;
        arrival reached{};
        if (locating) reached = arrival_of(i, step, side);
        if (scans || crossed.any_of() || (locating ? !reached.is_plain() : is_last)) {
            if constexpr (Method::first_same_as_last) {
                step.slope1 = get_lanes<R>(ends.slope_end, i);
            } else {
                step.slope1 = detail::evaluate_rhs<Model>(step.t1, step.y1, p);
                add_to_count(s.extra_evaluations, i);
            }
        }
        R low = R(0), high = R(1);
        if (MYRIAD_UNLIKELY(scans)) {
            crossed = scan(i, step, side, low, high);
            if (locating) reached = arrival_of(i, step, side);
        }
        if (crossed.any_of()) {
            know_start(i, step, side);
            begin_or_shorten(i, step, side, crossed, low, high, events);
            return trial_outcome::is_redone;
        }
        if (locating) {
            if (sides_are_known && reached.is_plain()) {
                const auto& redo = sides.memory_of(i).redo;
                MYRIAD_UNROLL
                for (int j = 0; j < m; ++j) events.put(j, i, redo.target == j, step.g1[j]);
                end_location(i);
                return trial_outcome::stands_before_sides;
            }
            if (arrive(i, step, side, reached, events) == trial_outcome::is_redone) return trial_outcome::is_redone;
        } else if (is_last) {
            know_start(i, step, side);
            end_on_root(i, step, side, events);
        }
        sides.follow(i, step, side);
        sides.note(i);
        return trial_outcome::stands;
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
    /// The event to which the step was redone is reached.
    MYRIAD_FUNCTION void end_location(int i) {
        sides.memory_of(i).locating = false;
        sides.note(i);
        stepping<Model, Method, S>{sides.args, sides.s}.resume(i, sides.memory_of(i).redo.resume);
    }

    /// Evaluates the event functions at the start of the step. A function at a jump that no step has passed yet counts
    /// as infinite.
    MYRIAD_FUNCTION void know_start(int i, ends_of_step& step, const reals& side) const {
        step.g = detail::evaluate_events<Model>(step.t, step.y, step.p);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j)
            if (sides.memory_of(i).on_jump[j]) step.g[j] = copysign(R(infinity_of<R>), side[j]);
    }
    /// Checks `sub_samples` points of the step for the first crossing, updates the sides up to it, and sets [low, high]
    /// to the part of the step that contains it.
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
                if (!sides.is_timeless(i, length) && !sides.memory_of(i).on_jump[j]) e.left.set(j, i, true);
            }
        }
        return crossed;
    }

    /// Sets up a lane whose trial crossed: either a redone step, or an event at the start of the step.
    MYRIAD_FUNCTION void begin_or_shorten(int i, const ends_of_step& step, const reals& side, const flags& crossed,
                                          R low, R high, fired& events) {
        const auto& args = sides.args;
        auto& s = sides.s;
        auto& own = sides.memory_of(i);
        auto& redo = own.redo;
        const bool again = own.locating;
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
        own.locating = !here;
        sides.note(i);
        if (!here) return;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const bool near = abs(step.g[j]) <= args.event[j].tolerance;
            const bool happens = redo.target == j || (redo.crossed[j] && (near || redo.narrow));
            events.put(j, i, happens, step.g[j]);
        }
        stepping<Model, Method, S>{args, s}.resume(i, redo.resume);
    }

    /// How near to its event a redone step that did not cross has ended.
    struct arrival {
        R gap, tolerance;  // of the event's function
        bool others;       // other functions crossed in the trial before
        bool all_left;     // every function has left the surface since its event last fired

        /// A better guess is not worth another trial.
        MYRIAD_FUNCTION bool is_close() const { return abs(gap) <= R(arrival_part) * tolerance; }
        /// Only the event itself happens here.
        MYRIAD_FUNCTION bool is_plain() const { return is_close() && !others && all_left; }
    };
    MYRIAD_FUNCTION arrival arrival_of(int i, const ends_of_step& step, const reals& side) const {
        const auto& redo = sides.memory_of(i).redo;
        arrival reached{R(0), R(0), false, true};
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            reached.all_left = reached.all_left && sides.e.left.get(j, i);
            if (redo.target == j) {
                reached.gap = side[j] * step.g1[j];
                reached.tolerance = sides.args.event[j].tolerance;
            } else {
                reached.others = reached.others || redo.crossed[j];
            }
        }
        return reached;
    }

    /// Handles a redone step that ended before its crossing: within the tolerance its events fire; else it is
    /// lengthened.
    MYRIAD_FUNCTION trial_outcome arrive(int i, const ends_of_step& step, const reals& side, const arrival& reached,
                                         fired& events) {
        const auto& args = sides.args;
        auto& e = sides.e;
        auto& redo = sides.memory_of(i).redo;
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
            const bool short_of_it = reached.gap > reached.tolerance;
            bool further = short_of_it && !narrow && redo.tries < redo.most_trials;
            if (further) {
                redo.lengthen(step.h, guess);
            } else {
                further = abs(reached.gap) <= reached.tolerance && redo.improve(step.h, guess, reached.gap > R(0));
            }
            if (further) {
                add_to_count(sides.s.located, i);
                return trial_outcome::is_redone;
            }
        }
        const bool timeless = sides.is_timeless(i, step.h);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const R near = args.event[j].tolerance;
            const bool heads = abs(step.g1[j]) <= near && side[j] * slope[j] * step.h < R(0);
            const bool jumps = narrow && side[j] * step.g1[j] > near;
            const bool happens = redo.target == j || (redo.crossed[j] && (heads || jumps));
            events.put(j, i, happens, step.g1[j]);
            const bool at_jump = sides.memory_of(i).on_jump[j];
            if (!reached.all_left && !timeless && !at_jump && abs(middle[j]) > near) e.left.set(j, i, true);
        }
        end_location(i);
        return trial_outcome::stands;
    }

    /// Events at the end of the domain: a function within its tolerance and moving towards zero fires if it is past
    /// zero, or short of it by rounding alone, judged by both its slope and the last step. A function that settles at
    /// zero, or is still falling towards it, gets there later or never.
    MYRIAD_FUNCTION void end_on_root(int i, const ends_of_step& step, const reals& side, fired& events) {
        const reals slope = step.slopes1();
        const R rounding = end_rounding(i, step);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const R g = side[j] * step.g1[j], speed = -side[j] * slope[j] * sign_of(step.h);  // towards zero
            const R last_speed = (side[j] * step.g[j] - g) / abs(step.h);
            const bool at_zero = g <= R(0) || g <= (speed < last_speed ? speed : last_speed) * rounding;
            const bool near = abs(g) <= sides.args.event[j].tolerance;
            events.put(j, i, sides.is_asked(j, side[j]) && near && speed > R(0) && at_zero, step.g1[j]);
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
        return min(rounding, R(1.0 / 64) * abs(step.h));
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
