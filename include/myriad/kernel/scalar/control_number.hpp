// SPDX-License-Identifier: MIT
// The number type of step-size control, and its comparisons.
#pragma once

#include <type_traits>

#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

#if MYRIAD_FOR_GPU
// The parameter is used only because nvcc 13 crashes otherwise.
/// The type of the ratio of successive step sizes: single precision on GPUs, where double is slow and its
/// division slowest, and seven digits are more than a step size needs.
template <class S>
using control_of = std::conditional_t<true, float, S>;
#else
template <class S>
using control_of = S;
#endif

/// The larger and the smaller of two numbers; the second if one is NaN: one instruction fewer than max and min on both
/// backends.
template <class S>
struct one_of_two {
    static MYRIAD_FUNCTION S larger(const S& a, const S& b) { return select(a > b, a, b); }
    static MYRIAD_FUNCTION S smaller(const S& a, const S& b) { return select(a < b, a, b); }
};
template <class S>
MYRIAD_FUNCTION S larger(const S& a, const S& b) {
    return one_of_two<S>::larger(a, b);
}
template <class S>
MYRIAD_FUNCTION S smaller(const S& a, const S& b) {
    return one_of_two<S>::smaller(a, b);
}

/// a clamped to [low, high]; `low` if a is NaN.
template <class S>
MYRIAD_FUNCTION S limited(const S& a, const S& low, const S& high) {
#if MYRIAD_ON_GPU
    if constexpr (std::is_same_v<S, float>) return ::fminf(::fmaxf(a, low), high);
#endif
    return smaller(larger(a, low), high);
}

/// a / b and 1 / sqrt(a); on GPUs within a few ulps, without code for the ends of the range, where a / b is 0.
template <class S>
MYRIAD_FUNCTION S quotient(const S& a, const S& b) {
#if MYRIAD_ON_GPU
    static_assert(std::is_same_v<S, float>);
    return gpu::approximate_quotient(a, b);
#else
    return a / b;
#endif
}
template <class S>
MYRIAD_FUNCTION S inverse_root(const S& a) {
#if MYRIAD_ON_GPU
    static_assert(std::is_same_v<S, float>);
    return gpu::approximate_inverse_root(a);
#else
    return S(real_of<S>(1)) / sqrt(a);
#endif
}

/// Whether low <= |a| <= high; on GPUs the upper halves of the bits are compared, and equality with a limit's
/// counts as false.
template <class S>
MYRIAD_FUNCTION mask_of<S> clearly_between(const S& low, const S& a, const S& high) {
#if MYRIAD_ON_GPU
    if constexpr (std::is_same_v<S, double>) {
        const int size = gpu::upper_half(a) & 0x7fffffff;
        return (gpu::upper_half(low) < size) & (size < gpu::upper_half(high));
    }
#endif
    return (low <= abs(a)) & (abs(a) <= high);
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
