// SPDX-License-Identifier: MIT
// Elementary functions of a GPU's thread in single precision. CUDA's own sine, cosine and tangent have in every call a
// loop over the digits of pi, its power, root and division a slow path: 136, 93, 35 and 116 instructions, where these
// take 21, 61, 4 and 7. Theirs of the other functions have no branch, and are used where they are as short. Defining
// MYRIAD_EXACT_FLOAT, for a whole model file, gives CUDA's for all.
//
// Largest relative errors (docs/numerics/floating_point.md has the measurements): 1e-6, of sine and cosine 4e-7
// absolutely, for arguments and results that are normal. Results of exp and exp2 below the smallest normal number are
// zero, as in packs. NaN, infinities, zeros and what lies beyond a function's range give what CUDA's functions give.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/arithmetic.hpp"
#include "myriad/kernel/scalar/exponential.hpp"
#include "myriad/kernel/scalar/trigonometry.hpp"

#if MYRIAD_ON_GPU && !defined(MYRIAD_EXACT_FLOAT)
#define MYRIAD_FAST_FLOAT 1
#else
#define MYRIAD_FAST_FLOAT 0
#endif

namespace myriad::detail::inline MYRIAD_TARGET {

/// 96 bits of 4 / pi from each eighth one on, in words 0, 4 and 8 from there.
template <std::same_as<std::uint32_t> W>
MYRIAD_CONSTANT_MEMORY W digits_of_four_over_pi[] = {
    0x000000a2, 0x0000a2f9, 0x00a2f983, 0xa2f9836e, 0xf9836e4e, 0x836e4e44, 0x6e4e4415, 0x4e441529,
    0x441529fc, 0x1529fc27, 0x29fc2757, 0xfc2757d1, 0x2757d1f5, 0x57d1f534, 0xd1f534dd, 0xf534ddc0,
    0x34ddc0db, 0xddc0db62, 0xc0db6295, 0xdb629599, 0x6295993c, 0x95993c43, 0x993c4390, 0x3c439041};

#if MYRIAD_FAST_FLOAT
template <std::same_as<float> T>
struct fast_float {
    /// Two to the power x log2(e), corrected for what the product's rounding and its constant lose.
    static MYRIAD_FUNCTION T exp(T x) {
        using constants = exponential_constants<T>;
        const T power = x * constants::log2_e;
        const T value = gpu::approximate_exp2(power);
        const T lost = std::fma(-constants::ln_2, power, x);
        return gpu::grown_up_to(constants::exp_largest, x, value, lost);
    }
    static MYRIAD_FUNCTION T exp2(T x) { return gpu::approximate_exp2(x); }

    static MYRIAD_FUNCTION T log(T x) { return log_to_base(x, exponential_constants<T>::ln_2, T(1)); }
    static MYRIAD_FUNCTION T log2(T x) { return log_to_base(x, T(1), exponential_constants<T>::log2_e); }
    static MYRIAD_FUNCTION T log10(T x) { return log_to_base(x, T(0x1.344136p-2), exponential_constants<T>::log10_e); }

    // The branches for large angles come last: with what precedes them in one block, the compiler overlaps it.
    static MYRIAD_FUNCTION T sin(T x) {
        T result = sine_of(reduce(x));
        if (MYRIAD_UNLIKELY(!(std::fabs(x) <= limit))) result = sin_of_large(x);
        return result;
    }
    static MYRIAD_FUNCTION T cos(T x) {
        T result = cosine_of(reduce(x));
        if (MYRIAD_UNLIKELY(!(std::fabs(x) <= limit))) result = cos_of_large(x);
        return result;
    }
    static MYRIAD_FUNCTION T tan(T x) {
        T result = trigonometry<T>::tan(x);
        if (MYRIAD_UNLIKELY(!(std::fabs(x) <= trigonometry_constants<T>::limit))) result = tan_of_large(x);
        return result;
    }

    /// powr, whose error grows with |y|, within its range; all else is left to CUDA's.
    static MYRIAD_FUNCTION T pow(T x, T y) {
        T result = exponential<T>::powr(x, y);
        const bool usual = A::is_finite_from(smallest_normal_of<T>, x) && std::fabs(y) <= T(32);
        if (MYRIAD_UNLIKELY(!usual)) result = pow_of_any(x, y);
        return result;
    }
    static MYRIAD_FUNCTION T sqrt(T x) { return gpu::approximate_root_of_any(x); }
    /// For x in (0, 1]. The hardware's logarithm is as inexact near one as x is.
    static MYRIAD_FUNCTION T root_of_minus_log(T x) {
        return gpu::approximate_root(std::fabs(gpu::approximate_log2(x) * exponential_constants<T>::ln_2));
    }

    /// The angle of the slope y / x, turned by pi where x is negative, as -0 is.
    static MYRIAD_FUNCTION T atan2(T y, T x) {
        const T slope = std::atan(y / x);
        T result = (A::to_bits(x) & sign_bit) != 0 ? slope + std::copysign(T(0x1.921fb6p+1), y) : slope;
        if (MYRIAD_UNLIKELY(result != result)) result = atan2_of_any(y, x);
        return result;
    }

private:
    using A = arithmetic<T>;
    using bits = typename A::bits;
    static constexpr bits sign_bit = bits(1) << 31;

    static constexpr T limit = T(0x1p17);  // of sine and cosine

    /// The angle of x in its half wave, and in the highest bit whether that is an odd one. The first product and
    /// difference are exact.
    struct half_wave_angle {
        T rest;
        bits odd;
    };
    static MYRIAD_FUNCTION half_wave_angle reduce(T x) {
        const T shifted = std::fma(x, T(0x1.45f306p-2), round_to_whole<T>);
        const T n = shifted - round_to_whole<T>;
        const T rest = std::fma(n, T(-0x1.4442d2p-23), std::fma(n, T(-0x1.921fb4p+1), x));
        return {rest, static_cast<bits>(A::to_bits(shifted) << 31)};
    }
    /// The magnitude of a large angle without whole turns, in units of 2^-63 pi, by the digits of 4 / pi that matter
    /// (Payne and Hanek, ACM SIGNUM Newsletter 18 (1983) 19).
    static MYRIAD_FUNCTION std::uint64_t part_of_turn(T x) {
        const bits of_x = A::to_bits(std::fabs(x));
        const auto* digits = &digits_of_four_over_pi<bits>[(of_x >> 26) & 15];
        const bits fraction = ((of_x & 0x7fffff) | 0x800000) << ((of_x >> 23) & 7);
        const std::uint64_t high = static_cast<std::uint64_t>(fraction * digits[0]) << 32;
        const std::uint64_t middle = static_cast<std::uint64_t>(fraction) * digits[4];
        const std::uint64_t low = static_cast<std::uint64_t>(fraction) * digits[8] >> 32;
        return high + middle + low;
    }
    /// From the nearest multiple of 2^-63 pi 2^power, which is the k-th; NaN for infinity and NaN.
    template <int power>
    static MYRIAD_FUNCTION T rest_of_large(T x, std::uint64_t& k) {
        const std::uint64_t part = part_of_turn(x);
        k = (part + (std::uint64_t(1) << (power - 1))) >> power;
        const T rest = static_cast<T>(static_cast<std::int64_t>(part - (k << power))) * T(0x1.921fb6p-62);
        return std::fabs(x) <= largest_of<T> ? std::copysign(T(1), x) * rest : nan_of<T>;
    }
    static MYRIAD_FUNCTION half_wave_angle reduce_large(T x) {
        std::uint64_t n = 0;
        const T rest = rest_of_large<63>(x, n);
        return {rest, static_cast<bits>(n << 31)};
    }
    // Polynomials over half a wave (our own fits, errors 2^-27.5 of the sine and 2^-24 absolutely), by which a sine and
    // a cosine of one angle have everything but themselves in common. The special function unit would take longer over
    // two than the other pipes over these.
    static MYRIAD_FUNCTION T sine_of(const half_wave_angle& a) {
        const T z = a.rest * a.rest;
        const T tail = polynomial(z, T(-0x1.55554cp-3), T(0x1.110ef6p-7), T(-0x1.9f758ap-13), T(0x1.5e02d8p-19));
        return A::from_bits(A::to_bits(a.rest * std::fma(z, tail, T(1))) ^ a.odd);  // -0 keeps its sign
    }
    static MYRIAD_FUNCTION T cosine_of(const half_wave_angle& a) {
        const T z = a.rest * a.rest;
        const T value = polynomial(z, T(1), T(-0x1.ffffd2p-2), T(0x1.554f96p-5), T(-0x1.6b3610p-10), T(0x1.84ed78p-16));
        return A::from_bits(A::to_bits(value) ^ a.odd);
    }

    // Outside the ranges of the functions above: one copy each, out of line, as calls are rare.
    static MYRIAD_RARE_FUNCTION T sin_of_large(T x) { return sine_of(reduce_large(x)); }
    static MYRIAD_RARE_FUNCTION T cos_of_large(T x) { return cosine_of(reduce_large(x)); }
    static MYRIAD_RARE_FUNCTION T tan_of_large(T x) {
        std::uint64_t quarters = 0;
        const T tangent = trigonometry<T>::tan(rest_of_large<62>(x, quarters));
        return quarters % 2 == 0 ? tangent : T(-1) / tangent;
    }
    static MYRIAD_RARE_FUNCTION T pow_of_any(T x, T y) { return std::pow(x, y); }
    static MYRIAD_RARE_FUNCTION T atan2_of_any(T y, T x) { return std::atan2(y, x); }

    /// The hardware's logarithm, whose error is that of a number of order one: near one, a polynomial (our own fit of
    /// (log(1 + f) - f) / f^2 for |f| < 1/4, error 2^-22.8 of the logarithm).
    static MYRIAD_FUNCTION T log_to_base(T x, T of_two, T of_e) {
        const T f = x - T(1);
        const T tail = polynomial(f, T(-0x1.000078p-1), T(0x1.5556e8p-2), T(-0x1.ff0d1cp-3), T(0x1.98783ap-3),
                                  T(-0x1.733610p-3), T(0x1.425f78p-3));
        const T near_one = std::fma(f * f, tail, f) * of_e;
        const T elsewhere = gpu::approximate_log2_of_any(x) * of_two;
        return std::fabs(f) < T(0.25) ? near_one : elsewhere;
    }
};
#endif

}  // namespace myriad::detail::inline MYRIAD_TARGET
