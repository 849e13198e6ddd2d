// SPDX-License-Identifier: MIT
// What hooks have changed, lane by lane.
#pragma once

#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/scalar/arithmetic.hpp"
#include "myriad/kernel/scalar/lanes.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The new value in these lanes, the old one elsewhere.
template <class Mask, class T>
MYRIAD_FUNCTION T chosen(const Mask& lanes, const T& now, const T& before) {
    return select(lanes, now, before);
}
template <class Mask, class T, extent size>
MYRIAD_FUNCTION vec<T, size> chosen(const Mask& lanes, const vec<T, size>& now, const vec<T, size>& before) {
    vec<T, size> values;
    MYRIAD_UNROLL
    for (int c = 0; c < MYRIAD_LENGTH(size); ++c) values[c] = select(lanes, now[c], before[c]);
    return values;
}

/// The lanes of S in which they differ.
template <class S, class T, extent size>
MYRIAD_FUNCTION mask_of<S> differing(const vec<T, size>& now, const vec<T, size>& before) {
    mask_of<S> different = mask_of<S>(false);
    MYRIAD_UNROLL
    for (int c = 0; c < MYRIAD_LENGTH(size); ++c) different = different | differs_in_bits(now[c], before[c]);
    return different;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
