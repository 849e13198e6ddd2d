// SPDX-License-Identifier: MIT
// Refuses compiler options that assume there is no NaN or that reorder sums: a failed step is recognised by its NaN,
// and equal inputs must give equal bits wherever they are computed.
#pragma once

#include <limits>

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) || \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__)
#error \
    "Myriad is compiled with -ffast-math, -Ofast, or a part of them (-ffinite-math-only, -funsafe-math-optimizations, \
-fassociative-math, -freciprocal-math): compilers then remove the checks for NaN and reorder sums, so that failed \
steps pass for good ones. Take the option away, or put -fno-fast-math after it (-O3 after -Ofast), in all \
files that include Myriad"
#endif

namespace myriad::detail {

/// Why `computes_as_written()` is false, and what to do.
inline constexpr const char* not_as_written =
    "was compiled with a part of -ffast-math (such as clang++'s -fno-honor-nans, -fassociative-math or "
    "-funsafe-math-optimizations), so that NaN passes for a number or sums are reordered: compile it without, or with "
    "-fno-fast-math after it";

/// Whether NaN, infinity, sums and quotients are computed as written in the code around the call: g++ defines a macro
/// for each option that affects them, clang++ only for -ffast-math and -ffinite-math-only.
__attribute__((always_inline)) inline bool computes_as_written() {
    // volatile: unknown at compile time
    const volatile double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    const volatile double large = 0x1p53, one = 1, odd = 49;
    const double n = nan, i = inf, a = large, b = one, c = odd;
    return n != n && !(i <= std::numeric_limits<double>::max()) && (a + b) - a == 0 && c / 49 == 1;
}

}  // namespace myriad::detail
