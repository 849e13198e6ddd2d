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

/// x^exponent for one real or one SIMD batch (`B`, with integers `I`) of positive normal numbers, with the fused
/// multiply-add of that kind of number.
template <class R, class B, class I, class MultiplyAdd>
MYRIAD_FUNCTION B fast_power(const B& x, const B& exponent, MultiplyAdd&& multiply_add) {
    using format = float_format<R>;
    const I bits = std::bit_cast<I>(x);
    const B e = std::bit_cast<B>((bits >> format::mantissa) | I(format::magic_bits)) - B(format::magic + format::bias);
    const B m = std::bit_cast<B>((bits & I(format::mantissa_mask)) | I(format::one));  // in [1, 2)
    // Chebyshev fits: log2 on [1, 2) within 1.6e-5, exp2 on [-1/2, 1/2] within 4e-6.
    B log2_m = B(R(0.0439286278));
    for (const R c : {R(-0.409475586), R(1.61017755), R(-3.52021884), R(5.06975632), R(-2.79415368)})
        log2_m = multiply_add(log2_m, m, B(c));
    const B z = exponent * (e + log2_m);
    const B shifted = z + B(format::round_magic);
    const B f = z - (shifted - B(format::round_magic));
    B power = B(R(0.0096760371));
    for (const R c : {R(0.0559220356), R(0.240221074), R(0.693121034), R(1.00000008)})
        power = multiply_add(power, f, B(c));
    return std::bit_cast<B>(std::bit_cast<I>(power) + (std::bit_cast<I>(shifted) << format::mantissa));
}

}  // namespace detail

/// x^exponent within a relative error of about 2e-5, for x and the result within the range of normal numbers.
template <class S>
MYRIAD_FUNCTION S fast_power(const S& x, const S& exponent) {
    using R = real_of<S>;
#if defined(__CUDA_ARCH__)
    return static_cast<R>(::exp2f(static_cast<float>(exponent) * ::__log2f(static_cast<float>(x))));
#else
    using I = typename detail::float_format<R>::bits;
    if constexpr (lanes_of<S> == 1) {
        return detail::fast_power<R, R, I>(
            x, exponent, [](const R& a, const R& b, const R& c) MYRIAD_LAMBDA { return fma(a, b, c); });
    } else {
        S result;
        using B = typename S::batch_type;
        MYRIAD_UNROLL
        for (std::size_t i = 0; i < sizeof(result.parts) / sizeof(B); ++i)
            result.parts[i] = detail::fast_power<R, B, typename integer_of<S>::batch_type>(
                x.parts[i], exponent.parts[i],
                [](const B& a, const B& b, const B& c) MYRIAD_LAMBDA { return S::batch_fma(a, b, c); });
        return result;
    }
#endif
}

}  // namespace myriad::inline MYRIAD_TARGET
