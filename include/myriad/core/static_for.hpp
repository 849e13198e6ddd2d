// SPDX-License-Identifier: MIT
// A loop whose index is a compile-time constant: stages of a tableau and events, whose coefficients must fold.
#pragma once

#include <type_traits>
#include <utility>

#include "myriad/core/macros.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// Calls `f(std::integral_constant<int, i>{})` for i = begin, ..., end - 1.
template <int begin, int end, class F>
MYRIAD_FUNCTION constexpr void static_for(F&& f) {
    if constexpr (begin < end) {
        [&]<int... i>(std::integer_sequence<int, i...>) MYRIAD_LAMBDA {
            (f(std::integral_constant<int, begin + i>{}), ...);
        }(std::make_integer_sequence<int, end - begin>{});
    }
}

}  // namespace myriad::inline MYRIAD_TARGET
