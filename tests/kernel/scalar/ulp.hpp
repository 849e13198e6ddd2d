// SPDX-License-Identifier: MIT
// The error of a function value, with the next wider type as reference.
#pragma once

#include <cmath>
#include <limits>
#include <type_traits>

namespace tests {

template <class T>
using wider = std::conditional_t<std::is_same_v<T, double>, long double, double>;

/// |got - wanted| in units of the last place of `wanted`; for subnormal ones, of the smallest normal number.
template <class T>
double error_in_ulp(T got, wider<T> wanted) {
    if (std::isnan(got) || std::isnan(wanted)) return std::isnan(got) && std::isnan(wanted) ? 0 : 1e30;
    const T rounded = static_cast<T>(wanted);
    if (std::isinf(got) || std::isinf(rounded)) return got == rounded ? 0 : 1e30;
    const wider<T> scale = std::fmax(std::fabs(wanted), static_cast<wider<T>>(std::numeric_limits<T>::min()));
    const wider<T> ulp = std::ldexp(wider<T>(1), std::ilogb(scale) - (std::numeric_limits<T>::digits - 1));
    return static_cast<double>(std::fabs(static_cast<wider<T>>(got) - wanted) / ulp);
}

/// sin(pi x) in the wider type, with the reduction made before pi is rounded.
template <class W>
W wide_sinpi(W x) {
    const W half_turn = x - 2 * std::round(x / 2);
    const W folded = half_turn > W(0.5) ? 1 - half_turn : half_turn < W(-0.5) ? -1 - half_turn : half_turn;
    return std::sin(W(3.14159265358979323846264338327950288L) * folded);
}

template <class W>
W wide_cospi(W x) {
    return -wide_sinpi(std::fabs(x - 2 * std::round(x / 2)) - W(0.5));
}

}  // namespace tests
