// SPDX-License-Identifier: MIT
// On which side of zero each event function was last seen: what every step needs to know of its events, and no more.
#pragma once

#include <cstdint>

#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/scalar/mask_set.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// How a phase left an event function, for the next one, in `kernel_arguments::side`; negative where the side is below
/// zero.
enum class kept_side : std::int8_t {
    unknown = 0,  // on the surface: the side that the function heads for as the next phase begins
    within = 1,   // within its tolerance, having come from this side
    beyond = 2,   // if the next phase begins within the tolerance, something other than the integration put it there
    on_jump = 3,  // it fired right before a jump: on which side the next phase begins is to be seen
};

/// The sides of a pack's event functions. Empty for a model without events.
template <class Model, class S>
struct event_sides {
    using mask = mask_of<S>;
    using masks = mask_set<mask, n_event<Model>>;
    masks above;     // the side last seen, beyond the tolerance, is the positive one
    masks open;      // on the surface, the side not yet known
    masks left;      // the function has been beyond its tolerance since the event last fired
    masks on_jump;   // the event fired right before a jump that no step has passed yet; the side is the one beyond it
    mask undefined;  // a function has no value at the committed state
    mask locating;   // the next trial is a step redone to the time of an event

    MYRIAD_FUNCTION void clear() {
        above.clear();
        open.clear();
        left.clear();
        on_jump.clear();
        undefined = locating = mask(false);
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
