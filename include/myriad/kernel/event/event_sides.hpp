// SPDX-License-Identifier: MIT
// The side of zero on which each event function was last seen: all that an ordinary step needs to know of events.
#pragma once

#include <cstdint>

#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/scalar/mask_set.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// How a phase left an event function, for the next phase, in `kernel_arguments::side`; negative if the side is below
/// zero.
enum class kept_side : std::int8_t {
    unknown = 0,  // where the function is when the next phase begins
    within = 1,   // zero up to rounding, reached from this side
    beyond = 2,   // its sign: if the next phase begins on the surface, a hook or the host moved the state there
    on_jump = 3,  // it fired right before a jump: the next phase must find out on which side it begins
    fired = 4,    // it fired: the next phase takes the side that the function is heading for
};

/// What every step of a pack compares its event functions with. What few steps need is in event_memory.
template <class Model, class S>
struct event_sides {
    using mask = mask_of<S>;
    using masks = mask_set<mask, n_event<Model>>;
    enum lane_flag {
        in_question,  // every trial has to be looked at closely: event_memory says why
        undefined,    // a function is NaN at the committed state
        lane_flags
    };
    masks above;  // last seen on the positive side
    masks left;   // the function has left the surface since the event last fired
    mask_set<mask, lane_flags> flags;

    MYRIAD_FUNCTION void clear() {
        above.clear();
        left.clear();
        flags.clear();
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
