// SPDX-License-Identifier: MIT
// A loop whose index is a compile-time constant: stages of a tableau and events, whose coefficients must fold.
#pragma once

#include <utility>

#include "myriad/core/macros.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// A number known to the compiler, which converts to it in device code too.
template <int i>
struct constant_index {
    static constexpr int value = i;
    MYRIAD_FUNCTION constexpr operator int() const { return i; }
};

/// Calls `f(constant_index<i>{})` for i = begin, ..., end - 1.
template <int begin, int end, class F>
MYRIAD_FUNCTION constexpr void static_for(F&& f) {
    if constexpr (begin < end) {
        [&]<int... i>(std::integer_sequence<int, i...>) MYRIAD_LAMBDA {
            (f(constant_index<begin + i>{}), ...);
        }(std::make_integer_sequence<int, end - begin>{});
    }
}

}  // namespace myriad::inline MYRIAD_TARGET
