// SPDX-License-Identifier: MIT
// Detects events: every step checks the signs of the event functions, in all lanes at once.
#pragma once

#include "myriad/kernel/event/event_detection.hpp"
#include "myriad/kernel/event/lane_sides.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class S>
struct event_detector {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr auto m = n_event<Model>;
    using values = vec<S, m>;  // of the event functions in all lanes
    using masks = mask_set<mask, m>;
    using detection = event_detection<S, m>;

    lane_sides<Model, Method, S> sides;

    /// What the event functions g1 at the end of a trial show, whether it will be accepted or not.
    MYRIAD_FUNCTION detection detect(const values& g1) const {
        const auto& e = sides.e;
        detection detected{g1, {}, mask(false)};
        masks below;
        below.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) below.set_negative(j, g1[j]);
        // A function has crossed if it was above zero and is below, or was below and is above.
        detected.crossed = ~(e.above ^ below);
        detected.to_locate = e.flags[e.in_question] | (detected.crossed & (sides.asked() | ~e.left)).any_of();
        // A single lane has no branch here: in every step it would cost more than these comparisons.
        if (!is_pack<S> || any(sides.s.final_step)) {
            masks far;
            far.clear();
            MYRIAD_UNROLL
            for (int j = 0; j < MYRIAD_LENGTH(m); ++j) far.set(j, abs(g1[j]) > S(sides.args.event[j].end_tolerance));
            detected.to_locate = detected.to_locate | (sides.s.final_step & !far.all_of());
        }
        return detected;
    }
    /// Puts the functions that have crossed in the accepted trials of these lanes on their other side, but for those
    /// whose events were just located.
    MYRIAD_FUNCTION void change_sides(const mask& lanes, const detection& detected, const masks& located) const {
        masks crossed = detected.crossed.in(lanes);
        // A function whose event was just located, maybe past zero, changes its side after the event's action.
        if constexpr (!is_pack<S>) crossed = crossed & ~located;
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j)
            crossed.set(j, crossed[j] & (detected.g1[j] != S(R(0))));  // zero is on either side
        sides.e.above = sides.e.above ^ crossed;
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
