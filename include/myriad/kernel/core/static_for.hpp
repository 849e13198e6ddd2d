// SPDX-License-Identifier: MIT
// A loop whose index is a compile-time constant: for stages and events, whose coefficients must be constants too.
#pragma once

#include <utility>

#include "myriad/kernel/core/macros.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// A compile-time constant that converts to its value, in device code too.
template <int i>
struct constant_index {
    static constexpr int value = i;
    MYRIAD_FUNCTION operator int() const { return i; }
};

/// Calls `f(constant_index<i>{})` for i = begin, ..., end - 1.
template <int begin, int end, class F>
MYRIAD_FUNCTION void static_for(F&& f) {
    if constexpr (begin < end) {
        [&]<int... i>(std::integer_sequence<int, i...>) MYRIAD_LAMBDA { (f(constant_index<begin + i>{}), ...); }
        (std::make_integer_sequence<int, end - begin>{});
    }
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
