// SPDX-License-Identifier: MIT
// Sine, cosine and tangent of one SIMD batch, in radians and in half turns. Not xsimd's own, because those choose one of
// five argument reductions for all lanes by the largest of them, so that a lane's last bits depend on its neighbours; here
// one reduction serves every lane up to `limit`, and what lies beyond is left to the caller.
#pragma once

#include <cstdint>
#include <type_traits>

#include "myriad/core/macros.hpp"
#include "myriad/scalar/batch.hpp"
#include "myriad/scalar/math.hpp"

namespace myriad::inline MYRIAD_TARGET {
namespace detail {

// pi/2 is given in parts whose products with the number of quarter turns, and the first differences, are exact: with a
// fused multiply-add any parts are, without one they need trailing zeros, and the arguments a lower limit.
template <class T>
struct trigonometry_constants;

template <>
struct trigonometry_constants<double> {
    using bits = std::uint64_t;
    static constexpr double two_over_pi = 0x1.45f306dc9c883p-1;
#if MYRIAD_FUSED
    static constexpr double limit = 0x1p30;
    static constexpr double half_pi[] = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54, -0x1.f1976b7ed8fbcp-110};
#else
    static constexpr double limit = 0x1p20;
    static constexpr double half_pi[] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2e037073p-69};
#endif
    // Minimax on [-pi/4, pi/4] (own Remez fit, error 2^-58 of sin and 2^-64 of cos).
    static MYRIAD_FUNCTION auto sine(const auto& z) {
        return polynomial(z, -0x1.5555555555549p-3, 0x1.111111110f8a3p-7, -0x1.a01a019c15813p-13, 0x1.71de357a75729p-19,
                          -0x1.ae5e6808411cbp-26, 0x1.5d9373ef3d5d0p-33);
    }
    static MYRIAD_FUNCTION auto cosine(const auto& z) {
        return polynomial(z, 0x1.555555555554cp-5, -0x1.6c16c16c1521dp-10, 0x1.a01a019cbf0c9p-16,
                          -0x1.27e4f8126412dp-22, 0x1.1ee9f10f572c1p-29, -0x1.8fb1093a63d4cp-37);
    }
};

template <>
struct trigonometry_constants<float> {
    using bits = std::uint32_t;
    static constexpr float two_over_pi = 0x1.45f306p-1f;
#if MYRIAD_FUSED
    static constexpr float limit = 0x1p16f;
    static constexpr float half_pi[] = {0x1.921fb6p+0f, -0x1.777a5cp-25f, -0x1.ee59dap-50f};
#else
    static constexpr float limit = 0x1p13f;
    static constexpr float half_pi[] = {0x1.92p+0f, 0x1.fb4p-12f, 0x1.444p-24f, 0x1.68c234p-39f};
#endif
    // The same on [-0.79, 0.79] (error 2^-28 and 2^-33).
    static MYRIAD_FUNCTION auto sine(const auto& z) {
        return polynomial(z, -0x1.555546p-3f, 0x1.11076ap-7f, -0x1.994c24p-13f);
    }
    static MYRIAD_FUNCTION auto cosine(const auto& z) {
        return polynomial(z, 0x1.55554ap-5f, -0x1.6c0c1ap-10f, 0x1.99e0ecp-16f);
    }
};

template <class T>
struct trigonometry {
    using constants = trigonometry_constants<T>;
    using bits_type = typename constants::bits;
    using batch = xsimd::batch<T>;
    using bits_batch = xsimd::batch<bits_type>;
    static constexpr int to_sign = static_cast<int>(8 * sizeof(T)) - 2;  // moves bit 1 to the place of the sign

    /// An angle as a number of quarter turns and a rest in [-pi/4, pi/4].
    struct angle {
        batch rest;
        bits_batch quarters;
    };

    /// Of |x| up to `constants::limit`.
    static MYRIAD_FUNCTION angle reduce(const batch& magnitude) {
        const batch shifted = multiply_add(magnitude, batch(constants::two_over_pi), batch(round_to_whole<T>));
        const batch quarters = shifted - batch(round_to_whole<T>);
        batch rest = magnitude;
        MYRIAD_UNROLL
        for (const T part : constants::half_pi) rest = subtract_product(quarters, batch(part), rest);
        return {rest, bits_as<bits_type>(shifted)};
    }
    /// Of pi |x|, |x| up to a fourth of round_to_whole.
    static MYRIAD_FUNCTION angle reduce_half_turns(const batch& magnitude) {
        const batch shifted = magnitude + magnitude + batch(round_to_whole<T>);
        const batch quarters = shifted - batch(round_to_whole<T>);
        const batch rest = subtract_product(batch(T(0.5)), quarters, magnitude);  // exact
        return {batch(functions<T>::pi) * rest, bits_as<bits_type>(shifted)};
    }

    static MYRIAD_FUNCTION batch sine_of_rest(const angle& a) {
        const batch z = a.rest * a.rest;
        return multiply_add(z * a.rest, constants::sine(z), a.rest);
    }
    static MYRIAD_FUNCTION batch cosine_of_rest(const angle& a) {
        const batch z = a.rest * a.rest;
        const batch half = batch(T(0.5)) * z;
        const batch head = batch(T(1)) - half;
        const batch lost = (batch(T(1)) - head) - half;
        return head + multiply_add(z * z, constants::cosine(z), lost);
    }
    static MYRIAD_FUNCTION auto is_odd(const bits_batch& quarters) {
        return mask_cast<T>((quarters & bits_batch(bits_type{1})) != bits_batch(bits_type{0}));
    }
    static MYRIAD_FUNCTION batch sign_of(const batch& x) { return x & batch(-T(0)); }
    static MYRIAD_FUNCTION batch sign_from_bit_1(const bits_batch& quarters) {
        return bits_as<T>((quarters & bits_batch(bits_type{2})) << to_sign);
    }

    static MYRIAD_FUNCTION batch sine(const angle& a, const batch& x) {
        const batch magnitude = xsimd::select(is_odd(a.quarters), cosine_of_rest(a), sine_of_rest(a));
        return magnitude ^ sign_from_bit_1(a.quarters) ^ sign_of(x);
    }
    static MYRIAD_FUNCTION batch cosine(const angle& a) {
        const batch magnitude = xsimd::select(is_odd(a.quarters), sine_of_rest(a), cosine_of_rest(a));
        return magnitude ^ sign_from_bit_1(a.quarters + bits_batch(bits_type{1}));
    }

    static MYRIAD_FUNCTION batch sin(const batch& x) { return sine(reduce(xsimd::abs(x)), x); }
    static MYRIAD_FUNCTION batch cos(const batch& x) { return cosine(reduce(xsimd::abs(x))); }
    static MYRIAD_FUNCTION batch sinpi(const batch& x) { return sine(reduce_half_turns(xsimd::abs(x)), x); }
    static MYRIAD_FUNCTION batch cospi(const batch& x) { return cosine(reduce_half_turns(xsimd::abs(x))); }
    static MYRIAD_FUNCTION batch tan(const batch& x) {
        const angle a = reduce(xsimd::abs(x));
        const batch s = sine_of_rest(a);
        const batch c = cosine_of_rest(a);
        const auto odd = is_odd(a.quarters);
        const batch quotient = xsimd::select(odd, c, s) / xsimd::select(odd, s, c);
        return quotient ^ sign_from_bit_1(a.quarters + a.quarters) ^ sign_of(x);
    }
};

}  // namespace detail
}  // namespace myriad::inline MYRIAD_TARGET
