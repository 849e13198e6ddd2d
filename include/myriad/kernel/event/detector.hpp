// SPDX-License-Identifier: MIT
// Detects events: every step checks the signs of the event functions, in all lanes at once. A lane in which one has
// changed goes to the locator.
#pragma once

#include "myriad/kernel/event/locator.hpp"
#include "myriad/kernel/stepper/step.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class S>
struct event_detector {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr int n = n_state<Model>;
    static constexpr int m = n_event<Model>;
    using values = vec<S, m>;  // of the event functions in all lanes
    using masks = mask_set<mask, m>;
    using trial_type = trial_step<Method, S, n>;
    using fired = fired_events<Model, S>;
    using sight = event_sight<S, m>;
    using ends_type = trial_ends<Model, S>;

    event_locator<Model, Method, S>& locator;

    /// What the event functions g1 at the end of a trial show of it, whether it will be accepted or not.
    MYRIAD_FUNCTION sight watch(const values& g1) const {
        const auto& sides = locator.sides;
        const auto& e = sides.e;
        sight seen{g1, {}, mask(false)};
        masks below;
        below.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) below.set_negative(j, g1[j]);
        // A function has crossed if it was above zero and is below, or was below and is above.
        seen.crossed = ~(e.above ^ below);
        seen.busy = e.flags[e.in_question] | (seen.crossed & (sides.asked() | ~e.left)).any_of();
        // Without a branch in one lane, for which nearly every step would pay more than these comparisons.
        if (!is_pack<S> || any(sides.s.final_step)) {
            masks far;
            far.clear();
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j) far.set(j, abs(g1[j]) > S(sides.args.event[j].end_tolerance));
            seen.busy = seen.busy | (sides.s.final_step & !far.all_of());
        }
        return seen;
    }

    /// Checks an accepted trial that ends at t1. Lanes that crossed, or stopped short of their target, are set up for a
    /// redone step and removed from `accepted`. `events` then holds those that fired: at the end of the trial or, in
    /// lanes removed from `accepted`, at its start.
    MYRIAD_FUNCTION void look(const trial_type& trial, const S& t1, const sight& seen, mask& accepted, fired& events) {
        auto& sides = locator.sides;
        if constexpr (is_pack<S>) {
            events.which.clear();  // a pack's values lie in memory
            events.changed = mask(false);
        } else {
            events.clear();
        }
        const mask busy = sides.s.running() & seen.busy;
        mask follow = accepted & !busy;
        auto& e = sides.e;
        if (is_pack<S> || MYRIAD_UNLIKELY(any(busy | seen.crossed.any_of()))) {
            if (MYRIAD_UNLIKELY(any(busy))) {
                const ends_type ends = ends_of(trial, t1, seen.g1);
                if constexpr (is_pack<S>) {
                    // Copies, so that only these need an address and the caller's variables stay in registers.
                    mask still_accepted = accepted;
                    locator.look_out_of_line(busy, ends, seen, still_accepted, events);
                    accepted = still_accepted;
                } else {
                    if (accepted) {
                        const trial_outcome outcome = locator.look_closer(0, ends, seen, events);
                        accepted = outcome != trial_outcome::is_redone;
                        follow = outcome == trial_outcome::stands_before_sides;
                    } else {
                        locator.give_up(0);
                    }
                }
            }
            masks crossed = seen.crossed.in(follow);
            // A function whose event was just located, maybe past zero, changes its side after the event's action.
            if constexpr (!is_pack<S>) crossed = crossed & ~events.which;
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j) crossed.set(j, crossed[j] & (seen.g1[j] != S(R(0))));  // zero is on either side
            e.above = e.above ^ crossed;
        }
        e.left = e.left | masks::all_in(follow);
    }

private:
    MYRIAD_FUNCTION ends_type ends_of(const trial_type& trial, const S& t1, const values& g1) const {
        ends_type ends{t1, trial.y, trial.k[0], {}, g1};
        if constexpr (Method::first_same_as_last) ends.slope_end = trial.slope_end();
        return ends;
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
