// SPDX-License-Identifier: MIT
// The data that event location keeps per instance between steps. It lies in memory, as few steps need it.
#pragma once

#include <cstdint>

#include "myriad/kernel/event/redone_step.hpp"
#include "myriad/kernel/model/concepts.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class R>
struct event_memory {
    redone_step<R, n_event<Model>> redo;
    std::int32_t waited;                         // turns that it has waited for other threads' events
    vec<std::int32_t, n_event<Model>> lingered;  // how often in a row the event has fired without its function leaving
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
