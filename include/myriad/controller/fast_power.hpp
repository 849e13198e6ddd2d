// SPDX-License-Identifier: MIT
// A power for the step-size control, where four digits are enough: exponent bits and short polynomials instead of pow,
// which would cost as much as a right-hand side. Plain reals and packs give the same bits.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "myriad/scalar/math.hpp"
#include "myriad/scalar/select.hpp"

namespace myriad::inline MYRIAD_TARGET {
namespace detail {

template <class R>
struct float_format;
template <>
struct float_format<double> {
    using bits = std::int64_t;
    static constexpr int mantissa = 52;
    static constexpr bits one = 0x3ff0000000000000, mantissa_mask = 0x000fffffffffffff;
    static constexpr bits magic_bits = 0x4330000000000000;  // 2^52: an integer below it is its mantissa
    static constexpr double magic = 4503599627370496.0, round_magic = 6755399441055744.0, bias = 1023;
};
template <>
struct float_format<float> {
    using bits = std::int32_t;
    static constexpr int mantissa = 23;
    static constexpr bits one = 0x3f800000, mantissa_mask = 0x007fffff;
    static constexpr bits magic_bits = 0x4b000000;  // 2^23
    static constexpr float magic = 8388608.0f, round_magic = 12582912.0f, bias = 127;
};

/// log2(x) of one real or one SIMD batch (`B`, with integers `I`) of positive normal numbers, with the fused multiply-add of
/// that kind of number. Chebyshev fit on [1, 2) within 1.6e-5.
template <class R, class B, class I, class MultiplyAdd>
MYRIAD_FUNCTION B fast_log2(const B& x, MultiplyAdd&& multiply_add) {
    using format = float_format<R>;
    const I bits = std::bit_cast<I>(x);
    const B e = std::bit_cast<B>((bits >> format::mantissa) | I(format::magic_bits)) - B(format::magic + format::bias);
    const B m = std::bit_cast<B>((bits & I(format::mantissa_mask)) | I(format::one));  // in [1, 2)
    B log2_m = B(R(0.0439286278));
    for (const R c : {R(-0.409475586), R(1.61017755), R(-3.52021884), R(5.06975632), R(-2.79415368)})
        log2_m = multiply_add(log2_m, m, B(c));
    return e + log2_m;
}
/// 2^z likewise. Chebyshev fit on [-1/2, 1/2] within 4e-6.
template <class R, class B, class I, class MultiplyAdd>
MYRIAD_FUNCTION B fast_exp2(const B& z, MultiplyAdd&& multiply_add) {
    using format = float_format<R>;
    const B shifted = z + B(format::round_magic);
    const B f = z - (shifted - B(format::round_magic));
    B power = B(R(0.0096760371));
    for (const R c : {R(0.0559220356), R(0.240221074), R(0.693121034), R(1.00000008)})
        power = multiply_add(power, f, B(c));
    return std::bit_cast<B>(std::bit_cast<I>(power) + (std::bit_cast<I>(shifted) << format::mantissa));
}

/// The integers as wide as the reals of B, which is S or the batch that its packs are made of.
template <class S, class B>
struct integers_beside {
    using type = typename integer_of<S>::batch_type;
};
template <class S>
struct integers_beside<S, S> {
    using type = typename float_format<S>::bits;
};

/// Calls `part(x, multiply_add)` for a real, or for every batch of a pack.
template <class S, class Part>
MYRIAD_FUNCTION S part_by_part(const S& x, Part&& part) {
    using R = real_of<S>;
    if constexpr (lanes_of<S> == 1) {
        return part(x, [](const R& a, const R& b, const R& c) MYRIAD_LAMBDA { return fma(a, b, c); });
    } else {
        S result;
        using B = typename S::batch_type;
        MYRIAD_UNROLL
        for (std::size_t i = 0; i < sizeof(result.parts) / sizeof(B); ++i)
            result.parts[i] = part(
                x.parts[i], [](const B& a, const B& b, const B& c) MYRIAD_LAMBDA { return S::batch_fma(a, b, c); });
        return result;
    }
}

}  // namespace detail

/// The binary logarithm within about 2e-5, for x within the range of normal numbers.
template <class S>
MYRIAD_FUNCTION S fast_log2(const S& x) {
#if defined(__CUDA_ARCH__)
    float y;  // without the instructions that subnormal numbers take
    asm("lg2.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(static_cast<float>(x)));
    return static_cast<S>(y);
#else
    return detail::part_by_part(x, []<class B>(const B& part, auto&& multiply_add) MYRIAD_LAMBDA {
        using I = typename detail::integers_beside<S, B>::type;
        return detail::fast_log2<real_of<S>, B, I>(part, multiply_add);
    });
#endif
}

/// 2^z within a relative error of about 4e-6, for results within the range of normal numbers.
template <class S>
MYRIAD_FUNCTION S fast_exp2(const S& z) {
#if defined(__CUDA_ARCH__)
    float y;
    asm("ex2.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(static_cast<float>(z)));
    return static_cast<S>(y);
#else
    return detail::part_by_part(z, []<class B>(const B& part, auto&& multiply_add) MYRIAD_LAMBDA {
        using I = typename detail::integers_beside<S, B>::type;
        return detail::fast_exp2<real_of<S>, B, I>(part, multiply_add);
    });
#endif
}

/// x^exponent within a relative error of about 2e-5, for x and the result within the range of normal numbers.
template <class S>
MYRIAD_FUNCTION S fast_power(const S& x, const S& exponent) {
    return fast_exp2(exponent * fast_log2(x));
}

}  // namespace myriad::inline MYRIAD_TARGET
