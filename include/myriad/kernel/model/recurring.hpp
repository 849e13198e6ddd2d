// SPDX-License-Identifier: MIT
// Stop times at equal intervals, such as those of doses.
#pragma once

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/math.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// The time of number `number` of `count` stops, the first at `first` and then one every `interval`; infinity, which is
/// no stop, from `count` on. Computed from `first`, so that rounding does not accumulate.
template <class R, class Count>
MYRIAD_FUNCTION R recurring(int number, const R& first, const R& interval, const Count& count) {
    return static_cast<Count>(number) < count ? fma(static_cast<R>(number), interval, first)
                                              : R(infinity_of<real_of<R>>);
}

}  // namespace myriad::inline MYRIAD_TARGET
