// SPDX-License-Identifier: MIT
// A power function for step-size control, where four digits are enough: exponent bits and short polynomials instead of
// pow, which would cost as much as a right-hand side. Plain reals and packs give the same bits.
#pragma once

#include <cstdint>

#include "myriad/kernel/scalar/arithmetic.hpp"
#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {
template <class R>
struct float_format;
template <>
struct float_format<double> {
    static constexpr int mantissa = 52;
    static constexpr std::uint64_t one = 0x3ff0000000000000, mantissa_mask = 0x000fffffffffffff;
    static constexpr std::uint64_t magic_bits = 0x4330000000000000;  // 2^52, whose mantissa counts units
    static constexpr double magic = 4503599627370496.0, bias = 1023;
};
template <>
struct float_format<float> {
    static constexpr int mantissa = 23;
    static constexpr std::uint32_t one = 0x3f800000, mantissa_mask = 0x007fffff;
    static constexpr std::uint32_t magic_bits = 0x4b000000;  // 2^23
    static constexpr float magic = 8388608.0f, bias = 127;
};

// Both polynomials use Estrin's scheme, as the next step waits for them: with Horner's, a cheap step takes a tenth
// longer.

/// log2(x) of a real or a SIMD batch, positive and normal. Chebyshev fit on [1, 2) within 1.6e-5. The shift is
/// unsigned, as AVX2 has no arithmetic shift for 64 bits.
template <class B>
MYRIAD_FUNCTION B fast_log2_of(const B& x) {
    using A = arithmetic<B>;
    using R = typename A::real;
    using format = float_format<R>;
    using bits = typename A::bits;
    const bits x_bits = A::to_bits(x);
    const B e = A::from_bits((x_bits >> format::mantissa) | bits(format::magic_bits)) - B(format::magic + format::bias);
    const B m = A::from_bits((x_bits & bits(format::mantissa_mask)) | bits(format::one));  // in [1, 2)
    const B m2 = m * m;
    const B low = A::multiply_add(B(R(5.06975632)), m, B(R(-2.79415368)) + e);
    const B middle = A::multiply_add(B(R(1.61017755)), m, B(R(-3.52021884)));
    const B high = A::multiply_add(B(R(0.0439286278)), m, B(R(-0.409475586)));
    return A::multiply_add(m2, A::multiply_add(m2, high, middle), low);
}
/// 2^z in the same way. Chebyshev fit on [-1/2, 1/2] within 4e-6.
template <class B>
MYRIAD_FUNCTION B fast_exp2_of(const B& z) {
    using A = arithmetic<B>;
    using R = typename A::real;
    const B shifted = z + B(round_to_whole<R>);
    const B f = z - (shifted - B(round_to_whole<R>));
    const B f2 = f * f;
    const B low = A::multiply_add(B(R(0.693121034)), f, B(R(1.00000008)));
    const B middle = A::multiply_add(B(R(0.0559220356)), f, B(R(0.240221074)));
    const B power = A::multiply_add(f2, A::multiply_add(f2, B(R(0.0096760371)), middle), low);
    return A::from_bits(A::to_bits(power) + (A::to_bits(shifted) << float_format<R>::mantissa));
}

/// Calls `part(x)` for a real, or for each batch of a pack.
template <class S, class Part>
MYRIAD_FUNCTION S part_by_part(const S& x, Part&& part) {
    if constexpr (lanes_of<S> == 1) {
        return part(x);
    } else {
        S result;
        MYRIAD_UNROLL
        for (std::size_t i = 0; i < sizeof(result.parts) / sizeof(result.parts[0]); ++i)
            result.parts[i] = part(x.parts[i]);
        return result;
    }
}

/// log2(x) within about 2e-5, for normal x.
template <class S>
MYRIAD_FUNCTION S fast_log2(const S& x) {
#if MYRIAD_ON_GPU
    return static_cast<S>(gpu::approximate_log2(static_cast<float>(x)));
#else
    return detail::part_by_part(x, [](const auto& part) MYRIAD_LAMBDA { return detail::fast_log2_of(part); });
#endif
}

/// 2^z within a relative error of about 4e-6, for normal results.
template <class S>
MYRIAD_FUNCTION S fast_exp2(const S& z) {
#if MYRIAD_ON_GPU
    return static_cast<S>(gpu::approximate_exp2(static_cast<float>(z)));
#else
    return detail::part_by_part(z, [](const auto& part) MYRIAD_LAMBDA { return detail::fast_exp2_of(part); });
#endif
}

/// x^exponent within a relative error of about 2e-5, for normal x and results.
template <class S>
MYRIAD_FUNCTION S fast_power(const S& x, const S& exponent) {
    return fast_exp2(exponent * fast_log2(x));
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
