// SPDX-License-Identifier: MIT
// Exponential, logarithm and power of one SIMD batch or one plain real. Not xsimd's own: its pow is exp(y log x) in
// working precision, whose error in ulps grows with |y log x| (30 at x = 1e-10, y = 1.4), with pow(0, 0) = 0; its log
// of a subnormal number is wrong; and without AVX-512 its exp and log convert to integers lane by lane, which takes
// most of their time. CUDA's pow has a slow path that costs a stack frame and half the speed.
#pragma once

#include <cstdint>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/arithmetic.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {
// Polynomials from our own Remez fit, coefficients rounded, errors relative to the function: exp_tail is (e^r - 1 - r)
// / r^2 for |r| < log(2) / 2; log_tail is (log((1 + s) / (1 - s)) / s - 2) / s^2 in z = s^2 for |s| < 0.1716. The heads
// of split constants have trailing zeros, so that their product with an exponent is exact.
template <class T>
struct exponential_constants;

template <>
struct exponential_constants<double> {
    using bits = std::uint64_t;
    static constexpr int fraction_bits = 52;
    static constexpr bits fraction = 0x000fffffffffffff;
    static constexpr bits one = 0x3ff0000000000000;
    static constexpr bits sqrt_half = 0x3fe6a09e667f3bcd;
    static constexpr bits whole = 0x4330000000000000;  // 2^52, whose last bit is worth 1
    static constexpr double bias = 0x1p52 + 1023;
    static constexpr double log2_e = 0x1.71547652b82fep+0, log10_e = 0x1.bcb7b1526e50ep-2, ln_2 = 0x1.62e42fefa39efp-1;
    static constexpr double two_log2_e = 0x1.71547652b82fep+1, two_log2_e_rest = 0x1.777d0ffda0d24p-55;
    static constexpr double ln_2_head = 0x1.62e42fefa38p-1, ln_2_rest = 0x1.ef35793c7673p-45;
    static constexpr double log10_2_head = 0x1.34413509f78p-2, log10_2_rest = 0x1.fef311f12b358p-46;
    static constexpr double exp_smallest = -708.39, exp_largest = 0x1.62e42fefa39efp+9;  // for normal, finite results
    static constexpr double exp2_smallest = -1022, exp2_largest = 0x1.fffffffffffffp+9;
    static constexpr double split = 0x1p27 + 1;
    static MYRIAD_FUNCTION auto exp_tail(const auto& r) {  // error 2^-57
        return polynomial(r, 0x1.0000000000009p-1, 0x1.55555555554fbp-3, 0x1.5555555550b41p-5, 0x1.1111111127a0fp-7,
                          0x1.6c16c183ae6d5p-10, 0x1.a01a012a154a9p-13, 0x1.a0199b23c79b6p-16, 0x1.71df273cfabb2p-19,
                          0x1.28ac95d083d89p-22, 0x1.ad7aeaef8144ep-26);
    }
    static MYRIAD_FUNCTION auto log_tail(const auto& z) {  // error 2^-65
        return polynomial(z, 0x1.5555555555555p-1, 0x1.9999999999d11p-2, 0x1.24924924397fap-2, 0x1.c71c724b66aa4p-3,
                          0x1.745ce1c8e144ep-3, 0x1.3b20247bd42a1p-3, 0x1.0f67449f571b1p-3, 0x1.0f0dcf8938e48p-3);
    }
};

template <>
struct exponential_constants<float> {
    using bits = std::uint32_t;
    static constexpr int fraction_bits = 23;
    static constexpr bits fraction = 0x007fffff;
    static constexpr bits one = 0x3f800000;
    static constexpr bits sqrt_half = 0x3f3504f3;
    static constexpr bits whole = 0x4b000000;
    static constexpr float bias = 0x1p23f + 127;
    static constexpr float log2_e = 0x1.715476p+0f, log10_e = 0x1.bcb7b2p-2f, ln_2 = 0x1.62e430p-1f;
    static constexpr float two_log2_e = 0x1.7154760000000p+1f, two_log2_e_rest = 0x1.4ae0c00000000p-25f;
    static constexpr float ln_2_head = 0x1.62e4p-1f, ln_2_rest = 0x1.7f7d1cp-20f;
    static constexpr float log10_2_head = 0x1.344p-2f, log10_2_rest = 0x1.3509f8p-18f;
    static constexpr float exp_smallest = -87.33f, exp_largest = 0x1.62e42ep+6f;
    static constexpr float exp2_smallest = -126, exp2_largest = 0x1.fffffep+6f;
    static constexpr float split = 0x1p12f + 1;
    static MYRIAD_FUNCTION auto exp_tail(const auto& r) {  // error 2^-28
        return polynomial(r, 0x1.fffffcp-2f, 0x1.555492p-3f, 0x1.5558ecp-5f, 0x1.123988p-7f, 0x1.6a2660p-10f);
    }
    static MYRIAD_FUNCTION auto log_tail(const auto& z) {  // error 2^-34
        return polynomial(z, 0x1.555554p-1f, 0x1.999c26p-2f, 0x1.23d3e0p-2f, 0x1.f13b22p-3f);
    }
};

/// B is a batch or a plain real.
template <class B>
struct exponential {
    using A = arithmetic<B>;
    using T = typename A::real;
    using constants = exponential_constants<T>;
    using mask = typename A::mask;
    using bits = typename A::bits;

    /// e^rest * 2^exponent, with the exponent in the last bits of `shifted`; the result and 2^exponent are normal.
    static MYRIAD_FUNCTION B scaled_exp(const B& rest, const B& shifted) {
        const B value = B(T(1)) + A::multiply_add(rest * rest, constants::exp_tail(rest), rest);
        return A::from_bits(A::to_bits(value) + (A::to_bits(shifted) << constants::fraction_bits));
    }
    /// 0 below the range, infinity above it, NaN for NaN.
    static MYRIAD_FUNCTION B within(const B& value, const B& x, T smallest, T largest) {
        const B bounded = A::select(x <= B(largest), value, x * B(largest_of<T>));
        return A::select(x < B(smallest), B(T(0)), bounded);
    }
    struct reduced {
        B rest;
        B shifted;
    };
    static MYRIAD_FUNCTION reduced reduce(const B& x) {
        const B shifted = A::multiply_add(x, B(constants::log2_e), B(round_to_whole<T>));
        const B exponent = shifted - B(round_to_whole<T>);
        const B head = A::subtract_product(exponent, B(constants::ln_2_head), x);
        return {A::subtract_product(exponent, B(constants::ln_2_rest), head), shifted};
    }
    static MYRIAD_FUNCTION B exp(const B& x) {
        const reduced r = reduce(x);
        return within(scaled_exp(r.rest, r.shifted), x, constants::exp_smallest, constants::exp_largest);
    }
    static MYRIAD_FUNCTION B exp2(const B& x) {
        const B shifted = x + B(round_to_whole<T>);
        const B exponent = shifted - B(round_to_whole<T>);
        const B rest = (x - exponent) * B(constants::ln_2);
        return within(scaled_exp(rest, shifted), x, constants::exp2_smallest, constants::exp2_largest);
    }

    /// x = 2^exponent * fraction, sqrt(1/2) <= fraction <= sqrt(2), for positive normal x.
    struct scaled {
        B exponent;
        B fraction;
    };
    static MYRIAD_FUNCTION scaled split(const B& x) {
        const bits shifted = A::to_bits(x) + bits(constants::one - constants::sqrt_half);
        const bits exponent = (shifted >> constants::fraction_bits) | bits(constants::whole);
        const bits fraction = (shifted & bits(constants::fraction)) + bits(constants::sqrt_half);
        return {A::from_bits(exponent) - B(constants::bias), A::from_bits(fraction)};
    }
    /// log(fraction) = f - correction, plus `small`: log(1 + f) = f - (h - s (h + R)), h = f^2 / 2, s = f / (2 + f).
    static MYRIAD_FUNCTION B log_of_fraction(const B& fraction, const B& small) {
        const B f = fraction - B(T(1));
        const B s = f / (B(T(2)) + f);
        const B z = s * s;
        const B half_square = B(T(0.5)) * f * f;
        const B inner = A::multiply_add(s, A::multiply_add(z, constants::log_tail(z), half_square), small);
        return f - (half_square - inner);
    }
    static MYRIAD_FUNCTION B finite_or_same(const B& value, const B& x) {
        return A::select(x <= B(largest_of<T>), value, x + x);
    }
    static MYRIAD_FUNCTION B log_of_finite(const B& x) {
        const scaled parts = split(x);
        const B rest = log_of_fraction(parts.fraction, parts.exponent * B(constants::ln_2_rest));
        return A::multiply_add(parts.exponent, B(constants::ln_2_head), rest);
    }
    static MYRIAD_FUNCTION B log(const B& x) { return finite_or_same(log_of_finite(x), x); }
    static MYRIAD_FUNCTION B log2(const B& x) {
        const scaled parts = split(x);
        const B rest = log_of_fraction(parts.fraction, B(T(0)));
        return finite_or_same(A::multiply_add(rest, B(constants::log2_e), parts.exponent), x);
    }
    static MYRIAD_FUNCTION B log10(const B& x) {
        const scaled parts = split(x);
        const B rest = log_of_fraction(parts.fraction, B(T(0))) * B(constants::log10_e);
        const B small = A::multiply_add(parts.exponent, B(constants::log10_2_rest), rest);
        return finite_or_same(A::multiply_add(parts.exponent, B(constants::log10_2_head), small), x);
    }

    /// The cube root of a positive normal number: one Newton step from an estimate within a few hundred ulps.
    static MYRIAD_FUNCTION B cbrt(const B& x) {
        const B third = B(T(1) / T(3));
        const B first = exp(log(x) * third);
        return A::subtract_product(first - x / (first * first), third, first);
    }

    /// a * b - product without rounding error, for product = the rounded a * b (Dekker 1971 without fused operations).
    static MYRIAD_FUNCTION B product_error(const B& a, const B& b, const B& product) {
#if MYRIAD_FUSED
        return A::multiply_subtract(a, b, product);
#else
        const B a_wide = B(constants::split) * a;
        const B b_wide = B(constants::split) * b;
        const B a_head = a_wide - (a_wide - a);
        const B b_head = b_wide - (b_wide - b);
        const B a_rest = a - a_head;
        const B b_rest = b - b_head;
        return ((a_head * b_head - product) + a_head * b_rest + a_rest * b_head) + a_rest * b_rest;
#endif
    }
    /// log(x) as a sum of two numbers, to about 2^-61 absolutely beside the exponent's part (double; float 2^-32).
    struct sum {
        B head;
        B rest;
    };
    static MYRIAD_FUNCTION sum precise_log(const B& x) {
        const scaled parts = split(x);
        const B one = B(T(1));
        const B numerator = parts.fraction - one;
        const B denominator = parts.fraction + one;
        const B denominator_rest = parts.fraction - (denominator - one);
        const B reciprocal = one / denominator;
        const B s = numerator * reciprocal;
        const B product = s * denominator;
        const B remainder = (numerator - product) - product_error(s, denominator, product);
        const B s_rest = A::subtract_product(s, denominator_rest, remainder) * reciprocal;
        const B z = s * s;
        const B tail = A::multiply_add(s * z, constants::log_tail(z), s_rest + s_rest);
        const B of_exponent = parts.exponent * B(constants::ln_2_head);
        const B of_fraction = s + s;
        const B head = of_exponent + of_fraction;
        const B rest = (of_exponent - head) + of_fraction;
        return {head, rest + A::multiply_add(parts.exponent, B(constants::ln_2_rest), tail)};
    }

    /// a - s * b, for s close to a / b.
    static MYRIAD_FUNCTION B quotient_remainder(const B& s, const B& b, const B& a) {
#if MYRIAD_FUSED
        return A::subtract_product(s, b, a);
#else
        const B product = s * b;
        return (a - product) - product_error(s, b, product);
#endif
    }

    /// x to the power y for x >= 0, as in IEEE 754 (NaN for x < 0, powr(0, 0) and powr(inf, 0)), except that subnormal
    /// numbers count as zero; branch-free. The exponent's part y * e is exact to twice the precision, so that the error
    /// is that of y log2(fraction), |log2(fraction)| <= 1/2: it grows with |y|, not with x.
    static MYRIAD_FUNCTION B powr(const B& x, const B& y) {
        const B one = B(T(1));
        const scaled parts = split(x);
        const B numerator = parts.fraction - one;
        const B denominator = parts.fraction + one;
        const B reciprocal = A::reciprocal(denominator);
        const B s = numerator * reciprocal;
        const B denominator_rest = parts.fraction - (denominator - one);
        const B remainder = A::subtract_product(s, denominator_rest, quotient_remainder(s, denominator, numerator));
        const B z = s * s;
        const B tail = A::multiply_add(B(constants::log2_e) * z, constants::log_tail(z), B(constants::two_log2_e_rest));
        const B small = A::multiply_add(s, tail, B(constants::two_log2_e) * (remainder * reciprocal));
        const B logarithm = A::multiply_add(s, B(constants::two_log2_e), small);
        const B of_exponent = y * parts.exponent;
        const B lost = product_error(y, parts.exponent, of_exponent);
        const mask usual = A::is_finite_from(smallest_normal_of<T>, x);
        // for other x only the power's sign matters
        const B unusual = A::select(x >= B(T(0)), y * (x - one), B(nan_of<T>));
        const B power = A::select(usual, A::multiply_add(y, logarithm, of_exponent), unusual);
        const B shifted = power + B(round_to_whole<T>);
        const B exponent = shifted - B(round_to_whole<T>);
        const B rest = A::multiply_add(y, logarithm, of_exponent - exponent) + lost;
        const B result = scaled_exp(rest * B(constants::ln_2), shifted);
        const B beyond = A::select(power < B(T(0)), B(T(0)), power * B(infinity_of<T>));
        return A::select(usual & (power >= B(constants::exp2_smallest)) & (power <= B(constants::exp2_largest)), result,
                         beyond);
    }

    /// x to the power y where |x| and the result are normal; returns the other lanes, which the caller must handle.
    static MYRIAD_FUNCTION mask pow(B& result, const B& x, const B& y) {
        const B base = A::abs(x);
        const sum logarithm = precise_log(base);
        const B product = y * logarithm.head;
        const B product_rest = A::multiply_add(y, logarithm.rest, product_error(y, logarithm.head, product));
        const B exponent = product + product_rest;
        const B exponent_rest = (product - exponent) + product_rest;
        const reduced r = reduce(exponent);
        const B magnitude = scaled_exp(r.rest + exponent_rest, r.shifted);

        const B half_y = B(T(0.5)) * y;
        const mask even = A::floor(half_y) == half_y;
        const B sign = A::select(even, B(T(0)), x & B(-T(0)));
        const mask usual = (base >= B(smallest_normal_of<T>)) & (base <= B(largest_of<T>));
        const mask in_range = (exponent >= B(constants::exp_smallest)) & (exponent <= B(constants::exp_largest));
        const mask real = (A::floor(y) == y) | (x > B(T(0)));
        result = magnitude ^ sign;
        return ~(usual & in_range & real);
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
