// SPDX-License-Identifier: MIT
// The jumps of the past that have not yet arrived. Only in kernels of models with delays.
#pragma once

#include <cstdint>

#include "myriad/kernel/model/past_layout.hpp"
#include "myriad/kernel/scalar/lanes.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Of each lane. Empty for a model without delays.
template <class Model, class S, bool delays = has_delays<Model>>
struct breaking_state {};
template <class Model, class S>
struct breaking_state<Model, S, true> {
    std::int32_t listed[lanes_of<S>];                    // jumps since the beginning
    vec<std::int32_t, n_lag<Model>> next[lanes_of<S>];   // of each lag: the next of them to arrive
    vec<real_of<S>, n_lag<Model>> arrival[lanes_of<S>];  // and when, if that is known; else infinity
    mask_of<S> redone;                                   // the next step ends where one was found to arrive
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
