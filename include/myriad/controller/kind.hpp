// SPDX-License-Identifier: MIT
// The kind of number that step-size control computes with, and what it compares it with.
#pragma once

#include <type_traits>

#include "myriad/scalar/select.hpp"

namespace myriad::inline MYRIAD_TARGET {

#if defined(__CUDACC__)
// The parameter is used for nothing but that nvcc 13 crashes if it is not.
/// The kind of number that says how large a step is to be, against the last one: single precision in CUDA threads, where
/// double is slow and division slowest, and seven digits are more than a step size needs.
template <class S>
using control_of = std::conditional_t<true, float, S>;
#else
template <class S>
using control_of = S;
#endif

/// The larger and the smaller of two numbers, the second where one is NaN: one instruction less on each side than max and min.
template <class S>
MYRIAD_FUNCTION S larger(const S& a, const S& b) {
    return select(a > b, a, b);
}
template <class S>
MYRIAD_FUNCTION S smaller(const S& a, const S& b) {
    return select(a < b, a, b);
}

}  // namespace myriad::inline MYRIAD_TARGET
