// SPDX-License-Identifier: MIT
// Locates events: whether the trial of a lane crossed, and the step redone until it ends at the crossing. No trial is
// committed beyond a crossing.
//
// It works on one lane at a time, only where something happens, from recomputed values, so that it costs ordinary steps
// neither time nor registers.
#pragma once

#include "myriad/kernel/event/event_detection.hpp"
#include "myriad/kernel/event/event_location.hpp"
#include "myriad/kernel/event/general_locator.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The usual way to locate events: signs and given tolerances decide. Where rounding does, `general_locator` has the
/// general one.
template <class Model, class Method, class S>
struct event_locator {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr auto m = n_event<Model>;
    using reals = vec<R, m>;  // of the event functions in one lane
    using flags = mask_set<bool, m>;
    using ends_of_step = step_ends<Model, R>;
    using fired = fired_events<Model, S>;
    using location = event_location<Model, Method, S>;

    lane_sides<Model, Method, S> sides;

    /// Checks the trial of one lane in which an event may have fired.
    MYRIAD_FUNCTION trial_outcome locate(int i, const trial_ends<Model, S>& ends, const event_detection<S, m>& detected,
                                         fired& events) const {
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
            flags crossed = detected.crossed & sides.asked();
            if (is_plain(i, step, crossed)) return locate_plain(i, step, ends, crossed, events);
        } else {
            // Not the pack's values, which may round differently from those they are compared with.
            step.g1 = detail::evaluate_events<Model>(step.t1, step.y1, p);
        }
        if (leaves_plainly(i, step)) return trial_outcome::stands;
        auto& kept = sides.scratch().step;  // in registers, it would take those of the whole loop
        kept = step;
        return general_locator<Model, Method, S>{sides}.locate(i, kept, ends, events);
    }

    /// A redone step that failed its error test is not redone.
    MYRIAD_FUNCTION void stop_locating(int i) const { location{sides}.stop_locating(i); }
    /// Locates events in all of these lanes whose trial is accepted, and gives up in the others. Lanes whose step is
    /// redone are removed from `accepted`.
    __attribute__((noinline)) void locate_lanes(const mask& candidates, const trial_ends<Model, S>& ends,
                                                const event_detection<S, m>& detected, mask& accepted,
                                                fired& events) const {
        for_each_lane(candidates, [&](int i) MYRIAD_LAMBDA {
            if (!get_lane(accepted, i)) return stop_locating(i);
            if (locate(i, ends, detected, events) == trial_outcome::is_redone) set_lane(accepted, i, false);
        });
    }

private:
    /// Whether a trial does what nearly all do that begin on a surface where the last phase ended: it leaves, as the
    /// slopes at its start show, and no other function has crossed. If so, sets the sides at its end. That can be told
    /// without rounding errors, too, if tolerances were given.
    MYRIAD_FUNCTION bool leaves_plainly(int i, const ends_of_step& step) const {
        auto& e = sides.e;
        auto& own = sides.memory_of(i);
        if (!(own.held & own.open).any_of() || sides.is_locating(i) || own.on_jump.any_of() ||
            sides.args.sub_samples > 1)
            return false;
        const reals slope = step.slopes();
        flags above = e.above.of_lane(i);
        bool plain = !sides.is_timeless(i, step.h);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            const R tolerance = sides.args.event[j].tolerance, g = step.g1[j], first = slope[j] * step.h;
            plain = plain && tolerance > R(0) && abs(g) > tolerance;
            if (own.open[j]) {
                plain = plain && own.held[j];
                if (own.fired_last[j]) {
                    plain = plain && abs(first) > tolerance;
                    above.set(j, first > R(0));
                }
            }
            plain = plain && above[j] == (g > R(0));
        }
        if (!plain) return false;
        e.above.set_of_lane(i, above);
        e.left.set_of_lane(i, flags::all_in(true));
        own.open.clear();
        own.held.clear();
        own.fresh.clear();
        sides.update_in_question(i);
        return true;
    }
    /// Whether a trial does what nearly all do that come here: one function, of those in `crossed`, has crossed, or
    /// the step was redone to end at an event of one function and ends near it or short of it. That can be told
    /// without the rounding errors of the event functions if these are smaller than tolerances that were given: every
    /// function has a side and is beyond its tolerance, or near the event. One that has not left its surface since its
    /// event must be on the side that it was heading for.
    MYRIAD_FUNCTION bool is_plain(int i, const ends_of_step& step, flags& crossed) const {
        // Read all at once: on a GPU, one read waits as long as several.
        const auto& own = sides.memory_of(i);
        const flags unclear = own.open | own.on_jump, crossed_before = own.redo.crossed;
        const auto target = own.redo.target;
        const bool trusts_guesses = own.redo.trusts_guesses(step.h);
        const bool seeking = sides.is_locating(i) & (target != own.redo.none);
        bool plain = (sides.args.sub_samples <= 1) & !unclear.any_of();
        const R located_to = seeking ? own.redo.tolerance[target] : R(0);
        bool alone = seeking, close = false;
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            const R tolerance = sides.args.event[j].tolerance, g = abs(step.g1[j]);
            const bool left = sides.e.left.get(j, i), stays = (step.g1[j] > R(0)) == sides.e.above.get(j, i);
            const bool is_target = seeking & (target == j);
            const bool near = is_target & left & (g <= located_to);
            plain = plain & (tolerance > R(0)) & (near | ((g > tolerance) & (left | stays)));
            close = close | (near & is_close(g, located_to));
            alone = alone & left & (is_target | !crossed_before[j]);
            if (near) crossed.set(j, false);
        }
        if (!plain) return false;
        return crossed.any_of() ? !crossed.several() : alone & (close | trusts_guesses);
    }
    /// Whether a better guess is not worth another trial.
    static MYRIAD_FUNCTION bool is_close(R gap, R tolerance) { return gap <= R(arrival_part) * tolerance; }
    /// Locates the event of a trial for which `is_plain` holds.
    MYRIAD_FUNCTION trial_outcome locate_plain(int i, ends_of_step& step, const trial_ends<Model, S>& ends,
                                               const flags& crossed, fired& events) const {
        auto& own = sides.memory_of(i);
        if (crossed.any_of()) {
            reals side;
            MYRIAD_UNROLL
            for (int j = 0; j < MYRIAD_LENGTH(m); ++j) side[j] = sides.e.above.get(j, i) ? R(1) : R(-1);
            step.g = detail::evaluate_events<Model>(step.t, step.y, step.p);
            location{sides}.evaluate_end_slope(i, step, ends);
            location{sides}.begin_or_shorten(i, step, side, crossed, step_part<R>{},
                                             plain_nearness<Model, R>{sides.args}, events);
            return trial_outcome::is_redone;
        }
        auto& redo = own.redo;
        const R g = detail::element(step.g1, redo.target), tolerance = redo.tolerance[redo.target];
        if (!is_close(abs(g), tolerance)) {
            location{sides}.evaluate_end_slope(i, step, ends);
            const R guess = step.h - g * reciprocal(detail::element(step.slopes1(), redo.target));
            const flags above = sides.e.above.of_lane(i);  // a copy, else all sides would lie in memory for the index
            const bool before = (g > R(0)) == above[redo.target];
            bool further = abs(g) > tolerance;
            if (further) {
                redo.lengthen(step.h, guess);
            } else {
                further = redo.improve(step.h, guess, before);
            }
            if (further) {
                location{sides}.redo_step(i);
                return trial_outcome::is_redone;
            }
        }
        own.at_jump.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) events.put(j, i, redo.target == j, step.g1[j]);
        location{sides}.end(i);
        return trial_outcome::stands_before_sides;
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
