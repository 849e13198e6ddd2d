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
    using detection = event_detection<S, m>;
    using ends_type = trial_ends<Model, S>;

    event_locator<Model, Method, S>& locator;

    /// What the event functions g1 at the end of a trial show, whether it will be accepted or not.
    MYRIAD_FUNCTION detection detect(const values& g1) const {
        const auto& sides = locator.sides;
        const auto& e = sides.e;
        detection detected{g1, {}, mask(false)};
        masks below;
        below.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) below.set_negative(j, g1[j]);
        // A function has crossed if it was above zero and is below, or was below and is above.
        detected.crossed = ~(e.above ^ below);
        detected.to_locate = e.flags[e.in_question] | (detected.crossed & (sides.asked() | ~e.left)).any_of();
        if (any(sides.s.final_step)) {
            masks far;
            far.clear();
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j) far.set(j, abs(g1[j]) > S(sides.end_tolerance(j)));
            detected.to_locate = detected.to_locate | (sides.s.final_step & !far.all_of());
        }
        return detected;
    }

    /// Checks an accepted trial that ends at t1. Lanes that crossed, or stopped short of their target, are set up for a
    /// redone step and removed from `accepted`. `events` then holds those that fired: at the end of the trial or, in
    /// lanes removed from `accepted`, at its start.
    MYRIAD_FUNCTION void locate(const trial_type& trial, const S& t1, const detection& detected, mask& accepted,
                                fired& events) {
        auto& sides = locator.sides;
        if constexpr (is_pack<S>) {
            events.which.clear();  // a pack's values lie in memory
            events.changed = mask(false);
        } else {
            events.clear();
        }
        const mask candidates = sides.s.running() & detected.to_locate;
        mask follow = accepted & !candidates;
        if (MYRIAD_UNLIKELY(any(candidates))) {
            const ends_type ends = ends_of(trial, t1, detected.g1);
            if constexpr (is_pack<S>) {
                // Copies, so that only these need an address and the caller's variables stay in registers.
                mask still_accepted = accepted;
                locator.locate_lanes(candidates, ends, detected, still_accepted, events);
                accepted = still_accepted;
            } else {
                if (accepted) {
                    const trial_outcome outcome = locator.locate(0, ends, detected, events);
                    accepted = outcome != trial_outcome::is_redone;
                    follow = outcome == trial_outcome::stands_before_sides;
                } else {
                    locator.give_up(0);
                }
            }
        }
        auto& e = sides.e;
        masks crossed = detected.crossed.in(follow);
        // A function whose event was just located, maybe past zero, changes its side after the event's action.
        if constexpr (!is_pack<S>) crossed = crossed & ~events.which;
        if (is_pack<S> || MYRIAD_UNLIKELY(any(crossed.any_of()))) {
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j)
                crossed.set(j, crossed[j] & (detected.g1[j] != S(R(0))));  // zero is on either side
        }
        e.above = e.above ^ crossed;
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
