// SPDX-License-Identifier: MIT
// What the own elementary functions need beside + - * /: fused operations, bits, selection and polynomials, under one name
// for a plain real, on host and device, and for one SIMD batch (in batch.hpp).
#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>

#include "myriad/core/macros.hpp"
#include "myriad/scalar/select.hpp"

namespace myriad::inline MYRIAD_TARGET {
namespace detail {

/// Adding this rounds to a whole number and leaves its last bits in the last bits of the sum.
template <class T>
inline constexpr T round_to_whole = sizeof(T) == sizeof(double) ? T(0x1.8p52) : T(0x1.8p23);

/// The elementary functions of one kind of number; every kind specialises it, plain reals in math.hpp.
template <class S>
struct functions;

/// Of a plain real, or of a batch.
template <class B>
struct arithmetic;

template <std::floating_point T>
struct arithmetic<T> {
    using real = T;
    using mask = bool;
    using bits = std::conditional_t<sizeof(T) == sizeof(double), std::uint64_t, std::uint32_t>;

    static MYRIAD_FUNCTION T multiply_add(T a, T b, T c) { return functions<T>::fma(a, b, c); }
    static MYRIAD_FUNCTION T multiply_subtract(T a, T b, T c) { return functions<T>::fma(a, b, -c); }
    static MYRIAD_FUNCTION T subtract_product(T a, T b, T c) { return functions<T>::fma(-a, b, c); }
    static MYRIAD_FUNCTION T select(bool m, T a, T b) { return m ? a : b; }
    static MYRIAD_FUNCTION T abs(T x) { return functions<T>::abs(x); }
    static MYRIAD_FUNCTION T floor(T x) { return functions<T>::floor(x); }
    static MYRIAD_FUNCTION bits to_bits(T x) { return __builtin_bit_cast(bits, x); }
    static MYRIAD_FUNCTION T from_bits(bits b) { return __builtin_bit_cast(T, b); }
    static MYRIAD_FUNCTION bool is_odd(bits b) { return (b & 1) != 0; }
    static MYRIAD_FUNCTION T reciprocal(T x) { return functions<T>::reciprocal(x); }
    /// Whether x is at least `least` and finite, both positive: by the bits, which are off the floating-point pipe.
    static MYRIAD_FUNCTION bool is_finite_from(T least, T x) {
        const bits from = to_bits(least), last = to_bits(largest_of<T>);
        return to_bits(x) - from <= last - from;
    }
};

/// c0 + c1 x + c2 x^2 + ... by Horner's rule.
template <class B>
MYRIAD_FUNCTION B polynomial(const B&, typename arithmetic<B>::real c0) {
    return B(c0);
}
template <class B, class... More>
MYRIAD_FUNCTION B polynomial(const B& x, typename arithmetic<B>::real c0, More... more) {
    return arithmetic<B>::multiply_add(x, polynomial(x, more...), B(c0));
}

}  // namespace detail

/// Whether two numbers are not the same in every bit, which a NaN that stays one is: cheaper than comparing values with care
/// for NaN, and true for zeros of different sign.
template <plain_number T>
MYRIAD_FUNCTION bool differs_in_bits(const T& a, const T& b) {
    if constexpr (std::floating_point<T>) {
        return detail::arithmetic<T>::to_bits(a) != detail::arithmetic<T>::to_bits(b);
    } else {
        return a != b;
    }
}

}  // namespace myriad::inline MYRIAD_TARGET
