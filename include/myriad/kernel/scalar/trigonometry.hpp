// SPDX-License-Identifier: MIT
// Sine, cosine and tangent of one SIMD batch or one plain real, in radians and in half turns. Not xsimd's own, which
// choose one of five argument reductions for all lanes by the largest argument, so that a lane's last bits depend on
// its neighbours; nor CUDA's own, whose reduction of large angles is a branch with a stack frame in every call. Here
// one reduction serves every lane up to `limit`; the caller handles larger arguments.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/arithmetic.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {
/// x - c0 q - c1 q - ..., from left to right.
template <class B>
MYRIAD_FUNCTION B less_products(const B& x, const B&) {
    return x;
}
template <class B, class... More>
MYRIAD_FUNCTION B less_products(const B& x, const B& q, typename arithmetic<B>::real c0, More... more) {
    return less_products(arithmetic<B>::subtract_product(q, B(c0), x), q, more...);
}

// pi/2 is split into parts such that their products with the number of quarter turns, and the first differences, are
// exact: any parts will do with a fused multiply-add; without one they need trailing zeros, and the limit is lower.
template <class T>
struct trigonometry_constants;

template <>
struct trigonometry_constants<double> {
    static constexpr double two_over_pi = 0x1.45f306dc9c883p-1;
#if MYRIAD_FUSED
    static constexpr double limit = 0x1p30;
    static MYRIAD_FUNCTION auto reduced(const auto& x, const auto& quarters) {
        return less_products(x, quarters, 0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54, -0x1.f1976b7ed8fbcp-110);
    }
#else
    static constexpr double limit = 0x1p20;
    static MYRIAD_FUNCTION auto reduced(const auto& x, const auto& quarters) {
        return less_products(x, quarters, 0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2e037073p-69);
    }
#endif
    // Minimax on [-pi/4, pi/4] (our own Remez fit, error 2^-58 of sin and 2^-64 of cos).
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
    static constexpr float two_over_pi = 0x1.45f306p-1f;
#if MYRIAD_FUSED
    static constexpr float limit = 0x1p16f;
    static MYRIAD_FUNCTION auto reduced(const auto& x, const auto& quarters) {
        return less_products(x, quarters, 0x1.921fb6p+0f, -0x1.777a5cp-25f, -0x1.ee59dap-50f);
    }
#else
    static constexpr float limit = 0x1p13f;
    static MYRIAD_FUNCTION auto reduced(const auto& x, const auto& quarters) {
        return less_products(x, quarters, 0x1.92p+0f, 0x1.fb4p-12f, 0x1.444p-24f, 0x1.68c234p-39f);
    }
#endif
    // The same on [-0.79, 0.79] (error 2^-28 and 2^-33).
    static MYRIAD_FUNCTION auto sine(const auto& z) {
        return polynomial(z, -0x1.555546p-3f, 0x1.11076ap-7f, -0x1.994c24p-13f);
    }
    static MYRIAD_FUNCTION auto cosine(const auto& z) {
        return polynomial(z, 0x1.55554ap-5f, -0x1.6c0c1ap-10f, 0x1.99e0ecp-16f);
    }
};

/// For half_wave, as operands of its instructions: 1 / pi; pi in three parts; the coefficients of
/// (sin(r) / r - 1) / r^2 in powers of r^2, minimax in the relative error of the sine on [-pi/2, pi/2] (our own Remez
/// fit, 2^-57.4), without the two before the last, which a GPU's instructions contain; and 2^52, less a half.
template <std::same_as<double> T>
MYRIAD_CONSTANT_MEMORY T half_wave_constant[] = {0x1.45f306dc9c883p-2,    0x1.921fb54442d18p+1,  0x1.1a62633145c07p-53,
                                                 -0x1.f1976b7ed8fbcp-109, -0x1.5555555555558p-3, 0x1.11111111111cfp-7,
                                                 -0x1.a01a01a01c314p-13,  0x1.71de3a540d937p-19, -0x1.ae64551239f0dp-26,
                                                 0x1.8829ap-49,           0x1p52 - 0.5};

/// Sine and cosine of a plain double, each by one polynomial over half a wave: on a GPU in two thirds of the
/// instructions, and in a shorter chain, than CUDA's own, which convert to integers and load coefficients by quadrant.
/// For |x| up to `limit`; errors are at most 2.1 ulps.
template <std::same_as<double> T>
struct half_wave {
    static constexpr T limit = T(0x1p30);

    static MYRIAD_FUNCTION T sin(T x) {
        const T magnitude = std::fabs(x);
        const T shifted = std::fma(magnitude, half_wave_constant<T>[0], round_to_whole<T>);
        return negated_if_odd(of_rest(magnitude, shifted - round_to_whole<T>), shifted, A::to_bits(x) & sign_bit);
    }
    /// From the middle n + 1/2 of the half wave, as the cosine is zero there.
    static MYRIAD_FUNCTION T cos(T x) {
        constexpr T whole = T(0x1p52);
        const T magnitude = std::fabs(x);
#if defined(MYRIAD_GPU_HAS_FMA_ROUNDED_DOWN)
        const T shifted = gpu::fma_rounded_down(magnitude, half_wave_constant<T>[0], whole);
#else
        const T shifted = std::floor(magnitude * half_wave_constant<T>[0]) + whole;
#endif
        return negated_if_odd(of_rest(magnitude, shifted - half_wave_constant<T>[10]), shifted, sign_bit);
    }

private:
    using A = arithmetic<T>;
    using bits = typename A::bits;
    static constexpr bits sign_bit = static_cast<bits>(std::uint64_t(1) << 63);

    /// sin(x - n pi); the first product and difference are exact.
    static MYRIAD_FUNCTION T of_rest(T x, T n) {
        const auto& c = half_wave_constant<T>;
        const T r = std::fma(-n, c[3], std::fma(-n, c[2], std::fma(-n, c[1], x)));
        const T z = r * r;
        T sum = c[9];
        sum = std::fma(sum, z, T(-0x1.ae432p-41));
        sum = std::fma(sum, z, T(0x1.6123dp-33));
        MYRIAD_UNROLL
        for (int k = 8; k >= 4; --k) sum = std::fma(sum, z, c[k]);
        return std::fma(z * r, sum, r);
    }
    /// With the sign changed if `sign` is set, and once more if the last bit of `whole` is.
    static MYRIAD_FUNCTION T negated_if_odd(T value, T whole, bits sign) {
        const auto last = static_cast<bits>(static_cast<std::uint64_t>(A::to_bits(whole)) << 63);
        return A::from_bits(A::to_bits(value) ^ last ^ sign);
    }
};

/// B is a batch or a plain real.
template <class B>
struct trigonometry {
    using A = arithmetic<B>;
    using T = typename A::real;
    using constants = trigonometry_constants<T>;
    using bits = typename A::bits;
    static constexpr int to_sign = static_cast<int>(8 * sizeof(T)) - 2;  // moves bit 1 to the sign bit
    /// The largest number of half turns whose double still rounds to integers.
    static constexpr T half_turn_limit = sizeof(T) == sizeof(double) ? T(0x1p50) : T(0x1p21);

    /// An angle as a number of quarter turns and a remainder in [-pi/4, pi/4].
    struct angle {
        B rest;
        bits quarters;
    };

    /// For |x| up to `constants::limit`.
    static MYRIAD_FUNCTION angle reduce(const B& magnitude) {
        const B shifted = A::multiply_add(magnitude, B(constants::two_over_pi), B(round_to_whole<T>));
        const B quarters = shifted - B(round_to_whole<T>);
        return {constants::reduced(magnitude, quarters), A::to_bits(shifted)};
    }
    /// For pi |x|, |x| up to `half_turn_limit`.
    static MYRIAD_FUNCTION angle reduce_half_turns(const B& magnitude) {
        const B shifted = magnitude + magnitude + B(round_to_whole<T>);
        const B quarters = shifted - B(round_to_whole<T>);
        const B rest = A::subtract_product(B(T(0.5)), quarters, magnitude);  // exact
        return {B(functions<T>::pi) * rest, A::to_bits(shifted)};
    }

    static MYRIAD_FUNCTION B sine_of_rest(const angle& a) {
        const B z = a.rest * a.rest;
        return A::multiply_add(z * a.rest, constants::sine(z), a.rest);
    }
    static MYRIAD_FUNCTION B cosine_of_rest(const angle& a) {
        const B z = a.rest * a.rest;
        return A::multiply_add(z, A::multiply_add(z, constants::cosine(z), B(T(-0.5))), B(T(1)));
    }
    /// Corrected for the rounding of 1 - z / 2 by five more operations, which matter in a tangent (2.9 ulps instead of
    /// 3.0).
    static MYRIAD_FUNCTION B careful_cosine_of_rest(const angle& a) {
        const B z = a.rest * a.rest;
        const B half = B(T(0.5)) * z;
        const B head = B(T(1)) - half;
        const B lost = (B(T(1)) - head) - half;
        return head + A::multiply_add(z * z, constants::cosine(z), lost);
    }
    static MYRIAD_FUNCTION auto is_odd(const bits& quarters) { return A::is_odd(quarters); }
    static MYRIAD_FUNCTION bits sign_of(const B& x) { return A::to_bits(x) & A::to_bits(B(-T(0))); }
    static MYRIAD_FUNCTION bits sign_from_bit_1(const bits& quarters) { return (quarters & bits(bit_1)) << to_sign; }
    static MYRIAD_FUNCTION B with_sign(const B& magnitude, const bits& sign) {
        return A::from_bits(A::to_bits(magnitude) ^ sign);
    }

    static MYRIAD_FUNCTION B sine(const angle& a, const B& x) {
        const B magnitude = A::select(is_odd(a.quarters), cosine_of_rest(a), sine_of_rest(a));
        return with_sign(magnitude, sign_from_bit_1(a.quarters) ^ sign_of(x));
    }
    static MYRIAD_FUNCTION B cosine(const angle& a) {
        const B magnitude = A::select(is_odd(a.quarters), sine_of_rest(a), cosine_of_rest(a));
        return with_sign(magnitude, sign_from_bit_1(a.quarters + bits(bit_0)));
    }

    static MYRIAD_FUNCTION B sin(const B& x) { return sine(reduce(A::abs(x)), x); }
    static MYRIAD_FUNCTION B cos(const B& x) { return cosine(reduce(A::abs(x))); }
    static MYRIAD_FUNCTION B sinpi(const B& x) { return sine(reduce_half_turns(A::abs(x)), x); }
    static MYRIAD_FUNCTION B cospi(const B& x) { return cosine(reduce_half_turns(A::abs(x))); }
    static MYRIAD_FUNCTION B tan(const B& x) {
        const angle a = reduce(A::abs(x));
        const B s = sine_of_rest(a);
        const B c = careful_cosine_of_rest(a);
        const auto odd = is_odd(a.quarters);
        const B quotient = A::select(odd, c, s) / A::select(odd, s, c);
        return with_sign(quotient, sign_from_bit_1(a.quarters + a.quarters) ^ sign_of(x));
    }

    /// Both from one reduction, with the same results as sin and cos; NaN beyond the limit.
    static MYRIAD_FUNCTION void sincos(const B& x, B& sine_of_x, B& cosine_of_x) {
        const B magnitude = A::abs(x);
        both(reduce(magnitude), magnitude <= B(constants::limit), x, sine_of_x, cosine_of_x);
    }
    static MYRIAD_FUNCTION void sincospi(const B& x, B& sine_of_x, B& cosine_of_x) {
        const B magnitude = A::abs(x);
        both(reduce_half_turns(magnitude), magnitude <= B(half_turn_limit), x, sine_of_x, cosine_of_x);
    }

private:
    static constexpr typename arithmetic<T>::bits bit_0 = 1, bit_1 = 2;

    template <class Mask>
    static MYRIAD_FUNCTION void both(angle a, const Mask& within, const B& x, B& sine_of_x, B& cosine_of_x) {
        a.rest = A::select(within, a.rest, B(nan_of<T>));
        sine_of_x = sine(a, x);
        cosine_of_x = cosine(a);
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
