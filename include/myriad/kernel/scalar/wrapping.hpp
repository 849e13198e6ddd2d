// SPDX-License-Identifier: MIT
// Arithmetic of whole numbers that goes round at the ends of their range, as NumPy's does, where C++ leaves it
// undefined. Whole numbers in packs have 32 bits too, whatever the width of their lanes.
#pragma once

#include <concepts>
#include <type_traits>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// A whole number, or a pack of them.
template <class S>
inline constexpr bool is_whole = std::signed_integral<S>;
template <class S>
requires requires { typename S::value_type; }
inline constexpr bool is_whole<S> = std::signed_integral<typename S::value_type>;

/// A whole number for operations that wrap around.
template <class S>
struct wrapping_bits {
    using type = S;
    static MYRIAD_FUNCTION S result(const S& x) { return S::wrapped_to_32_bits(x); }
};
template <std::signed_integral S>
struct wrapping_bits<S> {
    using type = std::make_unsigned_t<S>;
    static MYRIAD_FUNCTION S result(type x) { return static_cast<S>(x); }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET

namespace myriad::inline MYRIAD_TARGET {

#define MYRIAD_WRAPPING(name, symbol)                                                                                  \
    template <class A, class B>                                                                                        \
    requires(detail::is_whole<A> && detail::is_whole<B>) MYRIAD_FUNCTION auto name(const A& a, const B& b) {           \
        using S = detail::common_kind<A, B>;                                                                           \
        using bits = detail::wrapping_bits<S>;                                                                         \
        using type = typename bits::type;                                                                              \
        return bits::result(static_cast<type>(detail::to_kind<S>(a)) symbol static_cast<type>(detail::to_kind<S>(b))); \
    }
/// The sum of two whole numbers, which goes round at the ends of their range.
MYRIAD_WRAPPING(wrapping_add, +)
/// The difference of two whole numbers, which goes round at the ends of their range.
MYRIAD_WRAPPING(wrapping_subtract, -)
/// The product of two whole numbers, which goes round at the ends of their range. Packs have none.
MYRIAD_WRAPPING(wrapping_multiply, *)
#undef MYRIAD_WRAPPING

}  // namespace myriad::inline MYRIAD_TARGET
