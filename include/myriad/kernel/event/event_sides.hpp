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
    unknown = 0,  // on the surface: the next phase takes the side that the function is heading for
    within = 1,   // within its tolerance, reached from this side
    beyond = 2,   // beyond it: if the next phase begins within the tolerance, a hook or the host moved the state there
    on_jump = 3,  // it fired right before a jump: the next phase must find out on which side it begins
};

/// The sides of a pack's event functions. Empty for a model without events.
template <class Model, class S>
struct event_sides {
    using mask = mask_of<S>;
    using masks = mask_set<mask, n_event<Model>>;
    masks above;     // last seen beyond the tolerance on the positive side
    masks open;      // on the surface, side not yet known
    masks left;      // the function has been beyond its tolerance since the event last fired
    masks on_jump;   // the event fired right before a jump that no step has passed yet; the side is the one beyond it
    mask undefined;  // a function is NaN at the committed state
    mask locating;   // the next trial is redone, to end at an event

    MYRIAD_FUNCTION void clear() {
        above.clear();
        open.clear();
        left.clear();
        on_jump.clear();
        undefined = locating = mask(false);
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
