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

}  // namespace myriad::detail::inline MYRIAD_TARGET
