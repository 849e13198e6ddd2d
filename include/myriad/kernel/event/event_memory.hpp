// SPDX-License-Identifier: MIT
// What the location of events keeps of one instance from step to step, in memory: it is needed in few steps.
#pragma once

#include <cstdint>

#include "myriad/kernel/event/redone_step.hpp"
#include "myriad/kernel/model/concepts.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class R>
struct event_memory {
    redone_step<R, n_event<Model>> redo;
    vec<std::int32_t, n_event<Model>> lingered;  // times that an event fired in a row without its function having left
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
