// SPDX-License-Identifier: MIT
// How near to zero event functions count as on their surface, at their event, or past it.
//
// Event location is compiled twice. Nearly always, tolerances were given, and functions are farther from zero than
// these: that is the plain kind. In the rest, rounding decides.
#pragma once

#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// For functions whose rounding errors do not matter, as the tolerances that were given are larger.
template <class Model, class R>
struct plain_nearness {
    static constexpr bool is_plain = true;

    const kernel_arguments<Model, R>& args;

    MYRIAD_FUNCTION R floor(int) const { return R(0); }
    MYRIAD_FUNCTION R band(int j) const { return args.event[j].tolerance; }
};

/// For any functions. It lies in memory, as few steps need it.
template <class R, int events>
struct event_nearness {
    static constexpr bool is_plain = false;

    vec<R, events> roundings, floors, bands, pasts;

    MYRIAD_FUNCTION R rounding(int j) const { return roundings[j]; }  ///< the rounding error at the end of the trial
    MYRIAD_FUNCTION R floor(int j) const { return floors[j]; }  ///< one that starts no farther starts on the surface
    MYRIAD_FUNCTION R band(int j) const { return bands[j]; }    ///< an event is located within this
    MYRIAD_FUNCTION R past(int j) const { return pasts[j]; }    ///< past zero by no more than this is no crossing
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
