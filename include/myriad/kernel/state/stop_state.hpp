// SPDX-License-Identifier: MIT
// Where the steps of a phase have to end before t_end. Only in kernels of models with stop times.
#pragma once

#include <cstdint>

#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/scalar/lanes.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The next stop of each lane. Empty for a model without stop times.
template <class Model, class S, bool stops = has_known_stops<Model>>
struct stop_state {};
template <class Model, class S>
struct stop_state<Model, S, true> {
    S next;                                                // the nearest stop time not yet reached, or t_end
    vec<std::int32_t, n_stop<Model>> number[lanes_of<S>];  // of the next stop of each kind
    // of each kind: when the stop before that number has acted, for as long as that is its time
    vec<real_of<S>, n_stop<Model>> acted[lanes_of<S>];
    bool backwards[lanes_of<S>];  // times decrease in this phase
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
