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
    vec<std::int32_t, n_event<Model>> lingered;  // how often in a row the event has fired without its function leaving

    /// As at the start of a phase in which no function is on its surface or at a jump.
    MYRIAD_FUNCTION void clear() {
        redo.clear();
        open.clear(), held.clear(), fired_last.clear(), fresh.clear(), on_jump.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < n_event<Model>; ++j) lingered[j] = 0;
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
template <class R, int events>
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
    vec<R, n_event<Model>> side;            // that the functions are on
    vec<R, n_event<Model>> slope, heading;  // at the end of a redone step,
    vec<R, n_event<Model>> middle;          // and values in the middle of it
};
template <class Model, class R>
struct event_scratch<Model, R, false> {};

/// What event location keeps and works on in a pack. One object, since each would take registers for its address.
template <class Model, class R, int lanes>
struct event_memories {
    event_memory<Model, R> lane[lanes] = {};
    event_scratch<Model, R> scratch;
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
