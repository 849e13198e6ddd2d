// SPDX-License-Identifier: MIT
// What the detector found of the event functions at the end of a trial step.
#pragma once

#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/scalar/mask_set.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The event functions at the end of a trial, compared with the sides they were on.
template <class S, extent events>
struct event_detection {
    vec<S, events> g1;
    mask_set<mask_of<S>, events> crossed;  // on the other side than it was, by the sign of its value
    mask_of<S> to_locate;                  // an accepted trial goes to the locator
};
template <class S>
struct event_detection<S, 0> {};

}  // namespace myriad::detail::inline MYRIAD_TARGET
