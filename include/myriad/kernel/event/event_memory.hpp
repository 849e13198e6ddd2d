// SPDX-License-Identifier: MIT
// The data that event location keeps per instance between steps. It lies in memory, as few steps need it.
#pragma once

#include <cstdint>

#include "myriad/kernel/event/event_nearness.hpp"
#include "myriad/kernel/event/redone_step.hpp"
#include "myriad/kernel/model/concepts.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class R>
struct event_memory {
    using flags = mask_set<bool, n_event<Model>>;
    redone_step<R, n_event<Model>> redo;
    event_nearness<R, n_event<Model>> near;  // of the trial in which events are located
    flags open;                              // on the surface, side not yet known
    flags held;                              // so, unless the state was moved: then it is the side noted
    flags fired_last;                        // the event fired where the last phase ended
    flags fresh;                             // the event fired at the committed state
    flags at_jump;                           // and its function has a jump there
    flags on_jump;  // the event fired right before a jump that no step has passed yet; the side is the one beyond it
    R jump_time;    // that it takes to pass it
    std::int32_t waited;                         // turns that it has waited for other threads' events
    std::int32_t moves;                          // how often in the phase actions of events have moved functions
    vec<std::int32_t, n_event<Model>> lingered;  // how often in a row the event has fired without its function leaving
    vec<std::int64_t, n_event<Model>> moved_at;  // the phase's trials when an action of its event moved its function

    /// As at the start of a phase in which no function is on its surface or at a jump.
    MYRIAD_FUNCTION void clear() {
        redo.clear();
        open.clear(), held.clear(), fired_last.clear(), fresh.clear(), on_jump.clear();
        moves = 0;
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(n_event<Model>); ++j) lingered[j] = 0, moved_at[j] = 0;
    }
};

/// The part of a step, in fractions of it, that contains the crossings.
template <class R>
struct step_part {
    R low = R(0), high = R(1);
    R turn = R(0);         // where the step is to end instead, if not zero
    bool scanned = false;  // found at points inside the step, and the slope at its end is known
};

/// What `step_scan` works on.
template <class R, extent events>
struct scanned_part {
    vec<dual<R>, events> before, after, inside;  // the event functions, with their slopes per step, at points of it
    R theta;                                     // the end of the part that is looked at
    R place;                                     // the point up to which is looked next
    R low, high;                                 // between which a function turns
    std::int32_t points, turns, function;        // how many and which were looked at
};

/// What locating an event works on, for one lane at a time. It lies in memory: in registers, it would lessen those that
/// every step has.
template <class Model, class R, bool events = (n_event<Model> > 0)>
struct event_scratch {
    step_ends<Model, R> step;
    event_place<Model, R> place;
    step_part<R> part;
    scanned_part<R, n_event<Model>> scanned;
    vec<R, n_event<Model>> side;  // that the functions are on
    // of the functions at one end of the step, with their values in the middle of it
    vec<R, n_event<Model>> tolerance, slope, heading, middle;
    mask_set<bool, n_event<Model>> crosses;
    bool flat;  // one of them has no slope that tells where it goes
    std::int32_t function;
};
template <class Model, class R>
struct event_scratch<Model, R, false> {};

/// The slope of x^n puts its zero n times too near: the largest n that is allowed for.
inline constexpr double most_flat = 8;

/// Finds the slopes of the event functions along the solution at the end of the step, or at its start, where they have
/// rounding errors `place.rounding`; their headings there, +1 or -1, in the direction of the step; and which of those
/// that crossed in the trial before cross at that very point, as far as can be told: those within the tolerance given,
/// and those on their other side as soon as rounding lets them move, or where those within their tolerance are zero.
/// The sign then tells, not the size at the point: it is the same for x and x^3.
template <class Model, class R>
MYRIAD_RARE_FUNCTION void look_around(event_scratch<Model, R>* at, const event_memory<Model, R>* own, bool at_start) {
    const auto& step = at->step;
    auto& place = at->place;
    place.p = step.p;
    place.h = step.h, place.first = R(0);
    place.bend = {};
    if (at_start) {
        place.t = step.t, place.y = step.y, place.slope = step.slope;
        place.here = step.g, at->tolerance = own->redo.tolerance;
    } else {
        place.t = step.t1, place.y = step.y1, place.slope = step.slope1;
        place.here = step.g1, at->tolerance = own->near.bands, place.rounding = own->near.roundings;
    }
    at->slope = detail::event_slopes<Model>(place.t, place.y, place.slope, place.p);
    at->crosses.clear();
    at->flat = false;
    const R most = R(largest_part) * abs(own->redo.whole);
    MYRIAD_ROLLED
    for (at->function = 0; at->function < MYRIAD_LENGTH(n_event<Model>); ++at->function) {
        MYRIAD_OPTIMISATION_BARRIER(at);  // else what it points to occupies registers throughout
        const int j = at->function;
        at->heading[j] = at->slope[j] != R(0) ? copysign(R(1), at->slope[j] * place.h) : R(0);
        if (!own->redo.crossed[j]) continue;
        at->flat = at->flat || !detail::tells_heading(at->slope[j]);
        if (!(at->tolerance[j] > place.rounding[j]) || !(at->side[j] * place.here[j] <= at->tolerance[j])) continue;
        at->crosses.set(j, true);
        if (!detail::tells_heading(at->slope[j])) continue;
        const R until_zero = R(most_flat) * at->side[j] * place.here[j] * reciprocal(abs(at->slope[j]));
        place.first = max(place.first, min(until_zero, most));  // until all that are within their tolerances are zero
    }
    MYRIAD_ROLLED
    for (at->function = 0; at->function < MYRIAD_LENGTH(n_event<Model>); ++at->function) {
        MYRIAD_OPTIMISATION_BARRIER(at);  // else what it points to occupies registers throughout
        const int j = at->function;
        if (!own->redo.crossed[j] || at->crosses[j]) continue;
        place.length = place.rounding[j] * reciprocal(abs(at->slope[j]));  // in which it moves by its rounding error
        MYRIAD_OPTIMISATION_BARRIER(at);
        R g = place.here[j], bound = max(at->tolerance[j], place.rounding[j]);
        if (place.length * R(64) <= abs(place.t) + abs(place.h) && place.length > R(0)) {
            const R length = copysign(max(place.length, place.first), place.h);
            MYRIAD_UNROLL
            for (int c = 0; c < MYRIAD_LENGTH(n_state<Model>); ++c)
                place.there[c] = fma(length, place.slope[c], place.y[c]);
            place.sign = detail::evaluate_events<Model>(place.t + length, place.there, place.p);
            MYRIAD_OPTIMISATION_BARRIER(at);
            g = place.sign[at->function], bound = R(0);
        }
        at->crosses.set(at->function, at->side[at->function] * g <= bound);
    }
    place.first = R(0);
}
/// Finds the headings of functions that `look_around` found without a slope that tells, by the values ahead.
template <class Model, class R>
MYRIAD_FUNCTION void find_headings_without_slope(event_scratch<Model, R>* at) {
    if (!MYRIAD_UNLIKELY(at->flat)) return;
    detail::find_first_signs(&at->place);
    MYRIAD_UNROLL
    for (int j = 0; j < MYRIAD_LENGTH(n_event<Model>); ++j)
        if (!detail::tells_heading(at->slope[j])) at->heading[j] = at->place.sign[j];
}

/// How many steps' rounding errors the time of an event may have: it is located to eight roundings of t.
inline constexpr int steps_of_location = 4;

/// Finds each event function beyond the end of the step, on a straight path, as `heading`: by as much later as rounding
/// errors may have made it, `rounding` in each of the `iterations` since an action of its own event moved it, and those
/// of the times of all actions. Begins a path there for the signs that functions show first beyond twice the longest
/// such time of those that get to zero.
template <class Model, class R>
MYRIAD_RARE_FUNCTION void begin_beyond(event_scratch<Model, R>* at, const event_memory<Model, R>* own, R rounding,
                                       std::int64_t iterations) {
    const auto& step = at->step;
    auto& place = at->place;
    place.p = step.p;
    place.t = step.t1, place.h = step.h, place.first = R(0);
    place.y = step.y1, place.slope = step.slope1;
    const R per_time = reciprocal(step.h);
    MYRIAD_UNROLL
    for (int c = 0; c < MYRIAD_LENGTH(n_state<Model>); ++c) place.bend[c] = (step.slope1[c] - step.slope[c]) * per_time;
    MYRIAD_ROLLED
    for (at->function = 0; at->function < MYRIAD_LENGTH(n_event<Model>); ++at->function) {
        MYRIAD_OPTIMISATION_BARRIER(at);  // else what it points to occupies registers throughout
        const auto steps = iterations - own->moved_at[at->function] + steps_of_location * own->moves;
        place.length = copysign(rounding * static_cast<R>(steps), step.h);
        MYRIAD_UNROLL
        for (int c = 0; c < MYRIAD_LENGTH(n_state<Model>); ++c)
            place.there[c] = fma(place.length, step.slope1[c], step.y1[c]);
        place.here = detail::evaluate_events<Model>(step.t1 + place.length, place.there, place.p);
        MYRIAD_OPTIMISATION_BARRIER(at);
        const int j = at->function;
        at->heading[j] = place.here[j];
        if (at->side[j] * step.g1[j] <= R(0) || at->side[j] * place.here[j] <= R(0))
            place.first = max(place.first, R(2) * abs(place.length));
    }
}

/// What event location keeps and works on in a pack. One object, since each would take registers for its address.
template <class Model, class R, int lanes>
struct event_memories {
    event_memory<Model, R> lane[lanes] = {};
    event_scratch<Model, R> scratch;
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
