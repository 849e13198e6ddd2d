// SPDX-License-Identifier: MIT
// Operations beyond + - * / that Myriad's elementary functions need: fused operations, bits, selection and polynomials,
// under the same names for a plain real, on host and device, and for one SIMD batch (in batch.hpp).
#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {
/// Adding this constant rounds to an integer, whose last bits are then the last bits of the sum.
template <class T>
inline constexpr T round_to_whole = sizeof(T) == sizeof(double) ? T(0x1.8p52) : T(0x1.8p23);

/// The elementary functions of one kind of number, specialised for each kind; for plain reals in math.hpp.
template <class S>
struct functions;

/// For a plain real, or a batch.
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
    /// Whether x is finite and at least `least`, both positive: tested by the bits, to spare the floating-point pipe.
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

/// Whether two numbers differ in any bit: true for zeros of different sign, false for an unchanged NaN. Cheaper than a
/// comparison of values that handles NaN.
template <class S>
struct bit_comparison {
    static MYRIAD_FUNCTION bool differs(const S& a, const S& b) {
        if constexpr (std::floating_point<S>) {
            return arithmetic<S>::to_bits(a) != arithmetic<S>::to_bits(b);
        } else {
            return a != b;
        }
    }
};
template <class S>
MYRIAD_FUNCTION auto differs_in_bits(const S& a, const S& b) {
    return bit_comparison<S>::differs(a, b);
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
