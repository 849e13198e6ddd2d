// SPDX-License-Identifier: MIT
// A derivative that knows whether it is always zero: in a Jacobian by groups of columns most are, and a compiler may
// not leave out 0 * x + y by itself, as x could be infinite.
#pragma once

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/math.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The derivative of a `dual<S, partial<S>>`. Where loops are written out, `zero` is known when the code is
/// compiled, and neither it nor the operations that it saves are left.
template <class S>
struct partial {
    S value;
    bool zero;  // then the value is zero too

    partial() = default;
    MYRIAD_FUNCTION partial(const S& value_) : value(value_), zero(false) {}
    static MYRIAD_FUNCTION partial none() {
        partial p(S(real_of<S>(0)));
        p.zero = true;
        return p;
    }
    MYRIAD_FUNCTION operator const S&() const { return value; }

    friend MYRIAD_FUNCTION partial operator-(const partial& a) { return a.zero ? a : partial(-a.value); }
    friend MYRIAD_FUNCTION partial operator+(const partial& a, const partial& b) {
        return a.zero ? b : b.zero ? a : partial(a.value + b.value);
    }
    friend MYRIAD_FUNCTION partial operator-(const partial& a, const partial& b) {
        return a.zero ? -b : b.zero ? a : partial(a.value - b.value);
    }
    friend MYRIAD_FUNCTION partial operator*(const partial& a, const S& b) { return a.zero ? a : partial(a.value * b); }
    friend MYRIAD_FUNCTION partial operator*(const S& a, const partial& b) { return b.zero ? b : partial(a * b.value); }
    friend MYRIAD_FUNCTION partial operator/(const partial& a, const S& b) { return a.zero ? a : partial(a.value / b); }
    friend MYRIAD_FUNCTION partial select(const mask_of<S>& first, const partial& a, const partial& b) {
        if (a.zero && b.zero) return a;
        return partial(select(first, a.value, b.value));
    }
    friend MYRIAD_FUNCTION partial add_product(const partial& a, const S& b, const partial& c) {
        return a.zero ? c : c.zero ? a * b : partial(functions<S>::fma(a.value, b, c.value));
    }
    friend MYRIAD_FUNCTION partial add_product(const S& a, const partial& b, const partial& c) {
        return add_product(b, a, c);
    }
};

/// The derivative of a constant.
template <class Derivative>
struct derivative_of_constant {
    static MYRIAD_FUNCTION Derivative get() { return Derivative(real_of<Derivative>(0)); }
};
template <class S>
struct derivative_of_constant<partial<S>> {
    static MYRIAD_FUNCTION partial<S> get() { return partial<S>::none(); }
};

/// a b + c
template <class S>
MYRIAD_FUNCTION S add_product(const S& a, const S& b, const S& c) {
    return functions<S>::fma(a, b, c);
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
