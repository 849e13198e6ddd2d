// SPDX-License-Identifier: MIT
// Division with the quotient rounded down, as Python and NumPy have it: `floor_divide` is their //, `floor_mod` their
// %, bit for bit, for every kind of number. Only in the last place do they differ from floor(a / b), which is 10 for 1
// / 0.1.
#pragma once

#include <concepts>
#include <type_traits>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/scalar/select.hpp"
#include "myriad/kernel/scalar/wrapping.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// The remainder of a division whose quotient is rounded down: it has the sign of the second, is zero or between zero
/// and the second, and is that of exact arithmetic, rounded. NaN for a zero divisor.
template <class A, class B>
requires detail::real_kind<detail::common_kind<A, B>> MYRIAD_FUNCTION auto floor_mod(const A& a, const B& b) {
    using S = detail::common_kind<A, B>;
    const S divisor = detail::to_kind<S>(b), zero = detail::to_kind<S>(0);
    const S rest = detail::functions<S>::fmod(detail::to_kind<S>(a), divisor);
    // The sums with zero give a zero the divisor's sign, and keep a dual number's derivative.
    return select(divisor < zero, -(zero - select(rest > zero, rest + divisor, rest)),
                  zero + select(rest < zero, rest + divisor, rest));
}
/// Of whole numbers; zero for a zero divisor.
template <std::signed_integral A, std::signed_integral B>
MYRIAD_FUNCTION auto floor_mod(A a, B b) {
    using T = std::common_type_t<A, B>;
    if (b == 0 || b == -1) return T(0);  // the latter as the quotient of the least number has no place
    const T rest = static_cast<T>(a % b);
    return static_cast<T>(rest != 0 && (rest < 0) != (b < 0) ? rest + b : rest);
}

/// The largest whole number that is not above the exact quotient of the two, rounded; a / b for a zero divisor.
template <class A, class B>
requires detail::real_kind<detail::common_kind<A, B>> MYRIAD_FUNCTION auto floor_divide(const A& a, const B& b) {
    using S = detail::common_kind<A, B>;
    if constexpr (detail::kind_rank<S> >= 2) {
        return S(floor_divide(detail::to_kind<S>(a).value, detail::to_kind<S>(b).value));  // without a derivative
    } else {
        using f = detail::functions<S>;
        const S x = detail::to_kind<S>(a), divisor = detail::to_kind<S>(b);
        const S zero = detail::to_kind<S>(0), one = detail::to_kind<S>(1);
        const S rest = f::fmod(x, divisor), whole = detail::rounded_quotient(S(x - rest), divisor);
        const auto below = ((rest < zero) & (divisor > zero)) | ((rest > zero) & (divisor < zero));
        const S quotient = f::rint(select(below, whole - one, whole));
        return select(divisor == zero, x / divisor, select(quotient == zero, f::copysign(zero, x / divisor), quotient));
    }
}
/// Of whole numbers; zero for a zero divisor.
template <std::signed_integral A, std::signed_integral B>
MYRIAD_FUNCTION auto floor_divide(A a, B b) {
    using T = std::common_type_t<A, B>;
    if (b == 0) return T(0);
    if (b == -1) return static_cast<T>(wrapping_subtract(T(0), a));
    return static_cast<T>(a / b - (a % b != 0 && (a < 0) != (b < 0) ? 1 : 0));
}

}  // namespace myriad::inline MYRIAD_TARGET
