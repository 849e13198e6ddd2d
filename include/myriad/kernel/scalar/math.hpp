// SPDX-License-Identifier: MIT
// The elementary functions for models, `using myriad::cos; cos(t)`, for every kind of number: here for plain reals on
// host and device, in pack_math.hpp for packs and in dual.hpp for dual numbers. One name each, so that qualified calls
// work whatever was included first.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>
#include <type_traits>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/exponential.hpp"
#include "myriad/kernel/scalar/fast_float.hpp"
#include "myriad/kernel/scalar/select.hpp"
#include "myriad/kernel/scalar/trigonometry.hpp"
#include "myriad/kernel/scalar/wrapping.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// A kind of number that the elementary functions accept.
template <class S>
concept real_kind = (kind_rank<S> > 0) || std::floating_point<S>;

#if MYRIAD_FOR_GPU
/// For large angles and those that are not finite: one copy, out of line, as the call is rare and its code long.
inline __device__ __noinline__ double sin_of_large(double x) { return std::sin(x); }
inline __device__ __noinline__ double cos_of_large(double x) { return std::cos(x); }
#endif

// In single precision on GPUs, functions of fast_float.hpp take the place of the standard library's.
#if MYRIAD_FAST_FLOAT
#define MYRIAD_STANDARD_OR_FAST(name, ...)       \
    if constexpr (sizeof(T) == sizeof(float)) {  \
        return fast_float<T>::name(__VA_ARGS__); \
    } else {                                     \
        return std::name(__VA_ARGS__);           \
    }
#else
#define MYRIAD_STANDARD_OR_FAST(name, ...) return std::name(__VA_ARGS__);
#endif

template <std::floating_point T>
struct functions<T> {
    static constexpr T pi = T(3.14159265358979323846L);
    static constexpr T largest = std::numeric_limits<T>::max();  // a constant, as device code cannot call max()

    static MYRIAD_FUNCTION T cbrt(T x) { return std::cbrt(x); }
    static MYRIAD_FUNCTION T abs(T x) { return std::fabs(x); }
    static MYRIAD_FUNCTION T floor(T x) { return std::floor(x); }
    static MYRIAD_FUNCTION T round(T x) { return std::round(x); }
    static MYRIAD_FUNCTION T rint(T x) { return std::rint(x); }
    static MYRIAD_FUNCTION T tan(T x) { MYRIAD_STANDARD_OR_FAST(tan, x) }
    static MYRIAD_FUNCTION T asin(T x) { return std::asin(x); }
    static MYRIAD_FUNCTION T acos(T x) { return std::acos(x); }
    static MYRIAD_FUNCTION T atan(T x) { return std::atan(x); }
    static MYRIAD_FUNCTION T sinh(T x) { return std::sinh(x); }
    static MYRIAD_FUNCTION T cosh(T x) { return std::cosh(x); }
    static MYRIAD_FUNCTION T tanh(T x) { return std::tanh(x); }
    static MYRIAD_FUNCTION T exp(T x) { MYRIAD_STANDARD_OR_FAST(exp, x) }
    static MYRIAD_FUNCTION T exp2(T x) { MYRIAD_STANDARD_OR_FAST(exp2, x) }
    static MYRIAD_FUNCTION T log(T x) { MYRIAD_STANDARD_OR_FAST(log, x) }
    static MYRIAD_FUNCTION T log2(T x) { MYRIAD_STANDARD_OR_FAST(log2, x) }
    static MYRIAD_FUNCTION T log10(T x) { MYRIAD_STANDARD_OR_FAST(log10, x) }
    static MYRIAD_FUNCTION T expm1(T x) { return std::expm1(x); }
    static MYRIAD_FUNCTION T log1p(T x) { return std::log1p(x); }
    static MYRIAD_FUNCTION T pow(T x, T y) { MYRIAD_STANDARD_OR_FAST(pow, x, y) }
    static MYRIAD_FUNCTION T powr(T x, T y) { return exponential<T>::powr(x, y); }
    static MYRIAD_FUNCTION void sincos(T x, T& sine, T& cosine) { trigonometry<T>::sincos(x, sine, cosine); }
    static MYRIAD_FUNCTION void sincospi(T x, T& sine, T& cosine) { trigonometry<T>::sincospi(x, sine, cosine); }
    static MYRIAD_FUNCTION T atan2(T y, T x) { MYRIAD_STANDARD_OR_FAST(atan2, y, x) }
    static MYRIAD_FUNCTION T hypot(T x, T y) { return std::hypot(x, y); }
    static MYRIAD_FUNCTION T copysign(T x, T sign) { return std::copysign(x, sign); }
    static MYRIAD_FUNCTION T fmod(T x, T y) { return std::fmod(x, y); }
    static MYRIAD_FUNCTION bool is_finite(T x) {
#if MYRIAD_ON_GPU
        // Tests the exponent, to spare the floating-point pipe.
        if constexpr (sizeof(T) == sizeof(double)) return (gpu::upper_half(x) & 0x7ff00000) != 0x7ff00000;
#endif
        return std::fabs(x) <= largest;
    }

    // Operands in the order of the x86 instructions, so that packs and plain reals agree for signed zeros too. On GPUs,
    // CUDA's own functions take one instruction in single precision, but a few more than this in double.
    static MYRIAD_FUNCTION T min(T a, T b) {
#if MYRIAD_ON_GPU
        if constexpr (sizeof(T) == sizeof(float)) return std::fmin(a, b);
#endif
        return b != b || a < b ? a : b;
    }
    static MYRIAD_FUNCTION T max(T a, T b) {
#if MYRIAD_ON_GPU
        if constexpr (sizeof(T) == sizeof(float)) return std::fmax(a, b);
#endif
        return b != b || a > b ? a : b;
    }

#if MYRIAD_ON_GPU
    // Correctly rounded, like CUDA's own, but shorter: one third-order step from the hardware's 20 bits, and
    // Markstein's correction of the root by its remainder. Numbers whose remainder would underflow are scaled by 2^108.
    static MYRIAD_FUNCTION T sqrt(T x) {
        if constexpr (sizeof(T) == sizeof(double)) {
            constexpr unsigned smallest = 0x03500000, infinite = 0x7ff00000;  // high words
            const bool ordinary = static_cast<unsigned>(gpu::upper_half(x)) - smallest < infinite - smallest;
            double root = sqrt_of_ordinary(x);
            if (MYRIAD_UNLIKELY(!ordinary)) root = sqrt_of_extreme(x);
            return root;
        } else {
            MYRIAD_STANDARD_OR_FAST(sqrt, x)
        }
    }
    static MYRIAD_FUNCTION double rsqrt_of_ordinary(double x) {
        const double r = gpu::approximate_inverse_root(x);
        const double error = fma(-x * r, r, 1.0);
        return fma(r * error, fma(error, 0.375, 0.5), r);
    }
    static MYRIAD_FUNCTION double sqrt_of_ordinary(double x) {
        const double r = rsqrt_of_ordinary(x), root = x * r;
        return fma(fma(-root, root, x), 0.5 * r, root);
    }
    static MYRIAD_FUNCTION double sqrt_of_extreme(double x) {
        return x == 0 || x > largest ? x : 0x1p-54 * sqrt_of_ordinary(0x1p108 * x);
    }
    static MYRIAD_FUNCTION T fma(T a, T b, T c) { return std::fma(a, b, c); }
    // The branches for large angles come last: with what precedes them in one block, the compiler overlaps it.
    static MYRIAD_FUNCTION T sin(T x) {
        if constexpr (sizeof(T) == sizeof(double)) {
            T result = half_wave<T>::sin(x);
            if (MYRIAD_UNLIKELY(!(std::fabs(x) <= half_wave<T>::limit))) result = sin_of_large(x);
            return result;
        } else {
            MYRIAD_STANDARD_OR_FAST(sin, x)
        }
    }
    static MYRIAD_FUNCTION T cos(T x) {
        if constexpr (sizeof(T) == sizeof(double)) {
            T result = half_wave<T>::cos(x);
            if (MYRIAD_UNLIKELY(!(std::fabs(x) <= half_wave<T>::limit))) result = cos_of_large(x);
            return result;
        } else {
            MYRIAD_STANDARD_OR_FAST(cos, x)
        }
    }
    static MYRIAD_FUNCTION T sinpi(T x) { return ::sinpi(x); }
    static MYRIAD_FUNCTION T cospi(T x) { return ::cospi(x); }
    static MYRIAD_FUNCTION T reciprocal(T x) {
        const T r = gpu::approximate_reciprocal(x);
        if constexpr (sizeof(T) == sizeof(double)) {
            const T error = fma(-x, r, T(1));
            return fma(fma(error, error, error), r, r);
        } else {
            return r;
        }
    }
    static MYRIAD_FUNCTION T rsqrt(T x) {
        if constexpr (sizeof(T) == sizeof(double)) {
            return rsqrt_of_ordinary(x);
        } else {
            return gpu::approximate_inverse_root(x);
        }
    }
#else
    static MYRIAD_FUNCTION T sin(T x) { return std::sin(x); }
    static MYRIAD_FUNCTION T cos(T x) { return std::cos(x); }
    static MYRIAD_FUNCTION T sqrt(T x) { return std::sqrt(x); }
    static MYRIAD_FUNCTION T fma(T a, T b, T c) {
#if MYRIAD_FUSED
        return std::fma(a, b, c);
#else
        return a * b + c;  // std::fma would be emulated: 50 times slower, and unlike the packs
#endif
    }
    static MYRIAD_FUNCTION T reciprocal(T x) { return T(1) / x; }
    static MYRIAD_FUNCTION T rsqrt(T x) { return T(1) / std::sqrt(x); }
    static MYRIAD_FUNCTION T sinpi(T x) {
        const T turn = T(2) * std::round(T(0.5) * x);
        const T half = x - turn;  // exact, in [-1, 1]
        const T quarter = std::fabs(half) > T(0.5) ? std::copysign(T(1), half) - half : half;
        return quarter == T(0) ? std::copysign(T(0), x) : std::sin(pi * quarter);
    }
    static MYRIAD_FUNCTION T cospi(T x) {
        const T half = std::fabs(x - T(2) * std::round(T(0.5) * x));
        return half > T(0.25) && half < T(0.75) ? std::sin(pi * (T(0.5) - half)) : std::cos(pi * half);
    }
#endif
};
#undef MYRIAD_STANDARD_OR_FAST

/// a / b rounded correctly, where other quotients in single precision are not, on GPUs.
template <class S>
MYRIAD_FUNCTION S rounded_quotient(const S& a, const S& b) {
#if MYRIAD_ON_GPU
    if constexpr (std::same_as<S, float>) return gpu::rounded_quotient(a, b);
#endif
    return a / b;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET

namespace myriad::inline MYRIAD_TARGET {

#define MYRIAD_UNARY(name)                    \
    template <detail::real_kind S>            \
    MYRIAD_FUNCTION S name(const S& x) {      \
        return detail::functions<S>::name(x); \
    }
/// Square root, correctly rounded, but for single precision on GPUs, within an ulp; NaN of negative numbers.
MYRIAD_UNARY(sqrt)
/// Cube root.
MYRIAD_UNARY(cbrt)
/// Absolute value.
MYRIAD_UNARY(abs)
/// The largest integer that is not above x.
MYRIAD_UNARY(floor)
/// The nearest integer, halves away from zero.
MYRIAD_UNARY(round)
/// The nearest integer, halves to the even one, as Python's and NumPy's round.
MYRIAD_UNARY(rint)
/// Sine of an angle in radians; on GPUs, in double precision, within 2.1 ulps.
MYRIAD_UNARY(sin)
/// Cosine of an angle in radians; on GPUs, in double precision, within 2.1 ulps.
MYRIAD_UNARY(cos)
/// Tangent of an angle in radians.
MYRIAD_UNARY(tan)
/// Inverse of the sine, from -pi / 2 to pi / 2; NaN outside [-1, 1].
MYRIAD_UNARY(asin)
/// Inverse of the cosine, from 0 to pi; NaN outside [-1, 1].
MYRIAD_UNARY(acos)
/// Inverse of the tangent, from -pi / 2 to pi / 2.
MYRIAD_UNARY(atan)
/// sin(pi x), exact at multiples of a half; cheaper than `sin` for large arguments.
MYRIAD_UNARY(sinpi)
/// cos(pi x), exact at multiples of a half.
MYRIAD_UNARY(cospi)
/// Hyperbolic sine.
MYRIAD_UNARY(sinh)
/// Hyperbolic cosine.
MYRIAD_UNARY(cosh)
/// Hyperbolic tangent.
MYRIAD_UNARY(tanh)
/// Exponential function.
MYRIAD_UNARY(exp)
/// 2 to the power of x.
MYRIAD_UNARY(exp2)
/// Natural logarithm; NaN of negative numbers, minus infinity of zero.
MYRIAD_UNARY(log)
/// Logarithm to base 2, with the same exceptions as `log`.
MYRIAD_UNARY(log2)
/// Logarithm to base 10, with the same exceptions as `log`.
MYRIAD_UNARY(log10)
/// exp(x) - 1, accurate for small x.
MYRIAD_UNARY(expm1)
/// log(1 + x), accurate for small x.
MYRIAD_UNARY(log1p)
/// 1 / x, on GPUs without the slow path of a division: within 1 ulp for normal x and result; not finite for zero. For
/// infinity it is NaN in double precision on GPUs, and zero elsewhere.
MYRIAD_UNARY(reciprocal)
/// 1 / sqrt(x), on GPUs without a branch or a division: within 1.5 ulps, in single precision 2, for positive normal x.
/// For zero and infinity it is NaN in double precision on GPUs, and infinity and zero elsewhere.
MYRIAD_UNARY(rsqrt)
#undef MYRIAD_UNARY

/// What `sincos` and `sincospi` return.
template <class S>
struct sine_and_cosine {
    S sine;    ///< of the angle
    S cosine;  ///< of the same angle
};
/// Sine and cosine of the same angle for about the price of one: `const auto [sine, cosine] = sincos(x)` for x up to
/// 2^30 (float 2^16) in radians (2^20 and 2^13 if the target has no fused multiply-add), and sincospi for pi x up to
/// 2^50 (float 2^21). NaN beyond, so that there is no branch and the rest of a right-hand side can overlap with them;
/// sin and cos have no such limit. Errors are at most 2.5 and 2 ulps.
template <detail::real_kind S>
MYRIAD_FUNCTION sine_and_cosine<S> sincos(const S& x) {
    sine_and_cosine<S> both;
    detail::functions<S>::sincos(x, both.sine, both.cosine);
    return both;
}
/// Sine and cosine of pi x; see `sincos`.
template <detail::real_kind S>
MYRIAD_FUNCTION sine_and_cosine<S> sincospi(const S& x) {
    sine_and_cosine<S> both;
    detail::functions<S>::sincospi(x, both.sine, both.cosine);
    return both;
}

/// A mask: neither infinite nor NaN.
template <detail::real_kind S>
MYRIAD_FUNCTION auto is_finite(const S& x) {
    return detail::functions<S>::is_finite(x);
}

#define MYRIAD_BINARY(name)                                                                                            \
    template <class A, class B>                                                                                        \
    requires detail::real_kind<detail::common_kind<A, B>> MYRIAD_FUNCTION detail::common_kind<A, B> name(const A& a,   \
                                                                                                         const B& b) { \
        using S = detail::common_kind<A, B>;                                                                           \
        return detail::functions<S>::name(detail::to_kind<S>(a), detail::to_kind<S>(b));                               \
    }
/// The smaller of two; the number where the other argument is NaN.
MYRIAD_BINARY(min)
/// The larger of two; the number where the other argument is NaN.
MYRIAD_BINARY(max)
/// The magnitude of the first with the sign of the second.
MYRIAD_BINARY(copysign)
/// The angle of the point (second, first).
MYRIAD_BINARY(atan2)
/// sqrt(a^2 + b^2).
MYRIAD_BINARY(hypot)
/// The remainder of a division whose quotient is cut towards zero, with the sign of the first; exact.
MYRIAD_BINARY(fmod)
#undef MYRIAD_BINARY

/// For integers, such as integer accessories.
template <std::integral T>
MYRIAD_FUNCTION T min(T a, T b) {
    return b < a ? b : a;
}
template <std::integral T>
MYRIAD_FUNCTION T max(T a, T b) {
    return a < b ? b : a;
}
template <std::signed_integral T>
MYRIAD_FUNCTION T abs(T a) {
    return a < 0 ? wrapping_subtract(T(0), a) : a;
}

/// a * b + c, with one rounding if the target has the instruction and two otherwise, the same for every kind of number.
template <class A, class B, class C>
requires detail::real_kind<detail::common_kind<detail::common_kind<A, B>, C>> MYRIAD_FUNCTION auto fma(const A& a,
                                                                                                       const B& b,
                                                                                                       const C& c) {
    using S = detail::common_kind<detail::common_kind<A, B>, C>;
    return detail::functions<S>::fma(detail::to_kind<S>(a), detail::to_kind<S>(b), detail::to_kind<S>(c));
}

/// x to the power y for x >= 0, branch-free, in about half the time of pow: NaN for negative x, and for powr(0, 0) and
/// powr(inf, 0), as in IEEE 754; subnormal numbers count as zero. The error is at most 1.2 + |y| / 5 ulps (1.5 + |y| /
/// 2 if the target has no fused multiply-add). The exponent may not be a dual number.
template <class A, class B>
requires detail::real_kind<detail::common_kind<A, B>> MYRIAD_FUNCTION detail::common_kind<A, B> powr(const A& x,
                                                                                                     const B& y) {
    using S = detail::common_kind<A, B>;
    static_assert(detail::kind_rank<B> < 2, "powr has no derivative by its exponent: use pow");
    if constexpr (detail::kind_rank<A> >= 2) {
        return detail::functions<S>::powr(x, y);
    } else {
        return detail::functions<S>::powr(detail::to_kind<S>(x), detail::to_kind<S>(y));
    }
}

/// x to the power y. An int exponent is evaluated by multiplication, `pow(x, 3)` as x * x * x, with half an ulp of
/// error per product and for any sign of x.
template <class A, class B>
requires detail::real_kind<detail::common_kind<A, B>> MYRIAD_FUNCTION detail::common_kind<A, B> pow(const A& x,
                                                                                                    const B& y) {
    using S = detail::common_kind<A, B>;
    if constexpr (std::is_integral_v<B>) {
        const S one(static_cast<real_of<S>>(1));
        S result = one;
        S factor = x;
        for (auto n = y < 0 ? -static_cast<long long>(y) : static_cast<long long>(y); n != 0; n /= 2) {
            if (n % 2 != 0) result = result * factor;
            if (n > 1) factor = factor * factor;
        }
        return y < 0 ? one / result : result;
    } else if constexpr (detail::kind_rank<A> >= 2 && detail::kind_rank<B> < detail::kind_rank<A>) {
        return detail::functions<S>::pow_of_base(x, y);
    } else if constexpr (detail::kind_rank<B> >= 2 && detail::kind_rank<A> < detail::kind_rank<B>) {
        return detail::functions<S>::pow_of_exponent(x, y);
    } else {
        return detail::functions<S>::pow(detail::to_kind<S>(x), detail::to_kind<S>(y));
    }
}

}  // namespace myriad::inline MYRIAD_TARGET
