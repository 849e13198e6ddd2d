// SPDX-License-Identifier: MIT
// Exponential, logarithm and power of one SIMD batch. Not xsimd's own: its pow is exp(y log x) in working precision, which
// loses as many ulps as |y log x| is large (30 at x = 1e-10, y = 1.4) and has pow(0, 0) = 0; its log of a subnormal number
// is wrong; and without AVX-512 its exp and log convert to integers lane by lane, which takes most of their time.
#pragma once

#include <cstdint>
#include <limits>

#include "myriad/core/macros.hpp"
#include "myriad/scalar/batch.hpp"

namespace myriad::inline MYRIAD_TARGET {
namespace detail {

// Polynomials by an own Remez fit, coefficients rounded, errors relative to the function: exp_tail is (e^r - 1 - r) / r^2
// for |r| < log(2) / 2; log_tail is (log((1 + s) / (1 - s)) / s - 2) / s^2 in z = s^2 for |s| < 0.1716. Heads of constants
// have trailing zeros, so that their product with an exponent is exact.
template <class T>
struct exponential_constants;

template <>
struct exponential_constants<double> {
    using bits = std::uint64_t;
    static constexpr int fraction_bits = 52;
    static constexpr bits fraction = 0x000fffffffffffff;
    static constexpr bits one = 0x3ff0000000000000;
    static constexpr bits sqrt_half = 0x3fe6a09e667f3bcd;
    static constexpr bits whole = 0x4330000000000000;  // 2^52, whose last bits count units
    static constexpr double bias = 0x1p52 + 1023;
    static constexpr double log2_e = 0x1.71547652b82fep+0, log10_e = 0x1.bcb7b1526e50ep-2, ln_2 = 0x1.62e42fefa39efp-1;
    static constexpr double ln_2_head = 0x1.62e42fefa38p-1, ln_2_rest = 0x1.ef35793c7673p-45;
    static constexpr double log10_2_head = 0x1.34413509f78p-2, log10_2_rest = 0x1.fef311f12b358p-46;
    static constexpr double exp_smallest = -708.39, exp_largest = 0x1.62e42fefa39efp+9;  // results normal and finite
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

template <class T>
struct exponential {
    using constants = exponential_constants<T>;
    using bits_type = typename constants::bits;
    using batch = xsimd::batch<T>;
    using bits_batch = xsimd::batch<bits_type>;
    using mask = xsimd::batch_bool<T>;

    /// e^rest * 2^exponent, the exponent being the last bits of `shifted`; both the result and 2^exponent are normal.
    static MYRIAD_FUNCTION batch scaled_exp(const batch& rest, const batch& shifted) {
        const batch value = batch(T(1)) + multiply_add(rest * rest, constants::exp_tail(rest), rest);
        return bits_as<T>(bits_as<bits_type>(value) + (bits_as<bits_type>(shifted) << constants::fraction_bits));
    }
    /// 0 below the range, infinity above it, NaN for NaN.
    static MYRIAD_FUNCTION batch within(const batch& value, const batch& x, T smallest, T largest) {
        const batch bounded = xsimd::select(x <= batch(largest), value, x * batch(std::numeric_limits<T>::max()));
        return xsimd::select(x < batch(smallest), batch(T(0)), bounded);
    }
    struct reduced {
        batch rest;
        batch shifted;
    };
    static MYRIAD_FUNCTION reduced reduce(const batch& x) {
        const batch shifted = multiply_add(x, batch(constants::log2_e), batch(round_to_whole<T>));
        const batch exponent = shifted - batch(round_to_whole<T>);
        const batch head = subtract_product(exponent, batch(constants::ln_2_head), x);
        return {subtract_product(exponent, batch(constants::ln_2_rest), head), shifted};
    }
    static MYRIAD_FUNCTION batch exp(const batch& x) {
        const reduced r = reduce(x);
        return within(scaled_exp(r.rest, r.shifted), x, constants::exp_smallest, constants::exp_largest);
    }
    static MYRIAD_FUNCTION batch exp2(const batch& x) {
        const batch shifted = x + batch(round_to_whole<T>);
        const batch exponent = shifted - batch(round_to_whole<T>);
        const batch rest = (x - exponent) * batch(constants::ln_2);
        return within(scaled_exp(rest, shifted), x, constants::exp2_smallest, constants::exp2_largest);
    }

    /// x = 2^exponent * fraction with the fraction from sqrt(1/2) to sqrt(2), for positive normal x.
    struct scaled {
        batch exponent;
        batch fraction;
    };
    static MYRIAD_FUNCTION scaled split(const batch& x) {
        const bits_batch shifted = bits_as<bits_type>(x) + bits_batch(constants::one - constants::sqrt_half);
        const bits_batch exponent = (shifted >> constants::fraction_bits) | bits_batch(constants::whole);
        const bits_batch fraction = (shifted & bits_batch(constants::fraction)) + bits_batch(constants::sqrt_half);
        return {bits_as<T>(exponent) - batch(constants::bias), bits_as<T>(fraction)};
    }
    /// log(fraction) = f - correction, plus `small`: log(1 + f) = f - (h - s (h + R)), h = f^2 / 2, s = f / (2 + f).
    static MYRIAD_FUNCTION batch log_of_fraction(const batch& fraction, const batch& small) {
        const batch f = fraction - batch(T(1));
        const batch s = f / (batch(T(2)) + f);
        const batch z = s * s;
        const batch half_square = batch(T(0.5)) * f * f;
        const batch inner = multiply_add(s, multiply_add(z, constants::log_tail(z), half_square), small);
        return f - (half_square - inner);
    }
    static MYRIAD_FUNCTION batch finite_or_same(const batch& value, const batch& x) {
        return xsimd::select(x <= batch(std::numeric_limits<T>::max()), value, x + x);
    }
    static MYRIAD_FUNCTION batch log(const batch& x) {
        const scaled parts = split(x);
        const batch rest = log_of_fraction(parts.fraction, parts.exponent * batch(constants::ln_2_rest));
        return finite_or_same(multiply_add(parts.exponent, batch(constants::ln_2_head), rest), x);
    }
    static MYRIAD_FUNCTION batch log2(const batch& x) {
        const scaled parts = split(x);
        const batch rest = log_of_fraction(parts.fraction, batch(T(0)));
        return finite_or_same(multiply_add(rest, batch(constants::log2_e), parts.exponent), x);
    }
    static MYRIAD_FUNCTION batch log10(const batch& x) {
        const scaled parts = split(x);
        const batch rest = log_of_fraction(parts.fraction, batch(T(0))) * batch(constants::log10_e);
        const batch small = multiply_add(parts.exponent, batch(constants::log10_2_rest), rest);
        return finite_or_same(multiply_add(parts.exponent, batch(constants::log10_2_head), small), x);
    }

    /// The cube root of a positive normal number: one Newton step on a first value good to a few hundred ulps.
    static MYRIAD_FUNCTION batch cbrt(const batch& x) {
        const batch third = batch(T(1) / T(3));
        const batch first = exp(log(x) * third);
        return subtract_product(first - x / (first * first), third, first);
    }

    /// a * b - product without rounding error, for product = the rounded a * b (Dekker 1971 where nothing is fused).
    static MYRIAD_FUNCTION batch product_error(const batch& a, const batch& b, const batch& product) {
#if MYRIAD_FUSED
        return multiply_subtract(a, b, product);
#else
        const batch a_wide = batch(constants::split) * a;
        const batch b_wide = batch(constants::split) * b;
        const batch a_head = a_wide - (a_wide - a);
        const batch b_head = b_wide - (b_wide - b);
        const batch a_rest = a - a_head;
        const batch b_rest = b - b_head;
        return ((a_head * b_head - product) + a_head * b_rest + a_rest * b_head) + a_rest * b_rest;
#endif
    }
    /// log(x) as the sum of two numbers, to about 2^-61 absolutely beside the exponent's part (double; float 2^-32).
    struct sum {
        batch head;
        batch rest;
    };
    static MYRIAD_FUNCTION sum precise_log(const batch& x) {
        const scaled parts = split(x);
        const batch one = batch(T(1));
        const batch numerator = parts.fraction - one;
        const batch denominator = parts.fraction + one;
        const batch denominator_rest = parts.fraction - (denominator - one);
        const batch reciprocal = one / denominator;
        const batch s = numerator * reciprocal;
        const batch product = s * denominator;
        const batch remainder = (numerator - product) - product_error(s, denominator, product);
        const batch s_rest = subtract_product(s, denominator_rest, remainder) * reciprocal;
        const batch z = s * s;
        const batch tail = multiply_add(s * z, constants::log_tail(z), s_rest + s_rest);
        const batch of_exponent = parts.exponent * batch(constants::ln_2_head);
        const batch of_fraction = s + s;
        const batch head = of_exponent + of_fraction;
        const batch rest = (of_exponent - head) + of_fraction;
        return {head, rest + multiply_add(parts.exponent, batch(constants::ln_2_rest), tail)};
    }

    /// x to the power y where |x| and the result are normal numbers; returns the lanes that are not, left to the caller.
    static MYRIAD_FUNCTION mask pow(batch& result, const batch& x, const batch& y) {
        const batch base = xsimd::abs(x);
        const sum logarithm = precise_log(base);
        const batch product = y * logarithm.head;
        const batch product_rest = multiply_add(y, logarithm.rest, product_error(y, logarithm.head, product));
        const batch exponent = product + product_rest;
        const batch exponent_rest = (product - exponent) + product_rest;
        const reduced r = reduce(exponent);
        const batch magnitude = scaled_exp(r.rest + exponent_rest, r.shifted);

        const batch half_y = batch(T(0.5)) * y;
        const mask even = xsimd::floor(half_y) == half_y;
        const batch sign = xsimd::select(even, batch(T(0)), x & batch(-T(0)));
        const mask usual =
            (base >= batch(std::numeric_limits<T>::min())) & (base <= batch(std::numeric_limits<T>::max()));
        const mask in_range =
            (exponent >= batch(constants::exp_smallest)) & (exponent <= batch(constants::exp_largest));
        const mask real = (xsimd::floor(y) == y) | (x > batch(T(0)));
        result = magnitude ^ sign;
        return ~(usual & in_range & real);
    }
};

}  // namespace detail
}  // namespace myriad::inline MYRIAD_TARGET
