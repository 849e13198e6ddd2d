// SPDX-License-Identifier: MIT
// Dual numbers, a value with one derivative: a model's functions called with them give exact directional derivatives,
// for slopes of event functions and for Jacobians.
#pragma once

#include <type_traits>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/function_list.hpp"
#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/scalar/partial.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// value + derivative * e with e * e = 0; S is double, float or a pack, or itself dual, which gives second derivatives.
/// Mixes with S and with what S mixes with, which are constants. Comparisons use only the values. The derivative is
/// another S, a `partial<S>`, or several, `partials<S, count>`.
template <class S, class Derivative = S>
struct dual {
    using value_type = real_of<S>;

    S value;
    Derivative derivative;

    dual() = default;
    MYRIAD_FUNCTION dual(const S& value_, const Derivative& derivative_) : value(value_), derivative(derivative_) {}
    MYRIAD_FUNCTION dual(const S& constant)
        : value(constant), derivative(detail::derivative_of_constant<Derivative>::get()) {}
    MYRIAD_FUNCTION dual(value_type constant) requires(!std::is_same_v<S, value_type>) : dual(S(constant)) {}

    friend MYRIAD_FUNCTION dual operator-(const dual& a) { return dual(-a.value, -a.derivative); }
    friend MYRIAD_FUNCTION dual operator+(const dual& a) { return a; }

    template <class B>
    MYRIAD_FUNCTION dual& operator+=(const B& b) {
        return *this = *this + b;
    }
    template <class B>
    MYRIAD_FUNCTION dual& operator-=(const B& b) {
        return *this = *this - b;
    }
    template <class B>
    MYRIAD_FUNCTION dual& operator*=(const B& b) {
        return *this = *this * b;
    }
    template <class B>
    MYRIAD_FUNCTION dual& operator/=(const B& b) {
        return *this = *this / b;
    }

    static MYRIAD_FUNCTION dual blend(const mask_of<S>& mask, const dual& a, const dual& b) {
        return dual(select(mask, a.value, b.value), select(mask, a.derivative, b.derivative));
    }
    using lane_type = dual<value_type>;
    static MYRIAD_FUNCTION lane_type get_lane(const dual& a, int lane) {
        return lane_type(detail::get_lane(a.value, lane), detail::get_lane(static_cast<const S&>(a.derivative), lane));
    }
    static MYRIAD_FUNCTION void set_lane(dual& a, int lane, const lane_type& x) {
        detail::set_lane(a.value, lane, x.value);
        S derivative = a.derivative;
        detail::set_lane(derivative, lane, x.derivative);
        a.derivative = derivative;
    }
};

}  // namespace myriad::inline MYRIAD_TARGET

namespace myriad::detail::inline MYRIAD_TARGET {

template <class S, class Derivative>
struct scalar_traits<dual<S, Derivative>> {
    using real = real_of<S>;
    using mask = mask_of<S>;
    using integer = integer_of<S>;
    static constexpr int lanes = lanes_of<S>;
};

template <class S, class Derivative>
inline constexpr int kind_rank<dual<S, Derivative>> = kind_rank<S> < 2 ? 2 : kind_rank<S> + 1;

template <class A>
inline constexpr bool is_dual = kind_rank<A> >= 2;

template <class A, class B>
concept with_dual = (is_dual<A> || is_dual<B>)&&requires {
    typename common_kind_of<A, B>::type;
};
/// Whether A, beside the number B, is a constant: not dual, or dual of a lower rank.
template <class A, class B>
inline constexpr bool is_constant_beside = kind_rank<A> < kind_rank<B>;

template <class D>
struct dual_part;
template <class S, class Derivative>
struct dual_part<dual<S, Derivative>> {
    using type = S;
};
/// The kind of the numbers that a number with derivatives, or with second ones, consists of.
template <class S>
struct underlying_kind {
    using type = S;
};
template <class S, class Derivative>
struct underlying_kind<dual<S, Derivative>> : underlying_kind<S> {};
template <class S>
using without_derivative = typename underlying_kind<S>::type;

template <class A, class S>
inline constexpr bool is_dual_of = false;
template <class S, class Derivative>
inline constexpr bool is_dual_of<dual<S, Derivative>, S> = true;

/// The S of the dual number that is the common type of A and B.
template <class A, class B>
using part_of = typename dual_part<common_kind<A, B>>::type;

template <class S, class A>
MYRIAD_FUNCTION S value_of(const A& a) {
    if constexpr (is_dual_of<A, S>) {
        return a.value;
    } else {
        return to_kind<S>(a);
    }
}

}  // namespace myriad::detail::inline MYRIAD_TARGET

namespace myriad::inline MYRIAD_TARGET {

// The results are `auto`: clang 14 instantiates a named result type before it checks the constraint, which is an error
// for foreign types, such as iterators of a vector of this namespace's types. Constants and dual numbers are told
// apart, as multiplying by a zero derivative is not free and turns infinities into NaN.
template <class A, class B>
requires detail::with_dual<A, B> MYRIAD_FUNCTION auto operator+(const A& a, const B& b) {
    using D = detail::common_kind<A, B>;
    using S = detail::part_of<A, B>;
    const S value = detail::value_of<S>(a) + detail::value_of<S>(b);
    if constexpr (detail::is_constant_beside<B, A>) {
        return D(value, a.derivative);
    } else if constexpr (detail::is_constant_beside<A, B>) {
        return D(value, b.derivative);
    } else {
        return D(value, a.derivative + b.derivative);
    }
}

template <class A, class B>
requires detail::with_dual<A, B> MYRIAD_FUNCTION auto operator-(const A& a, const B& b) {
    using D = detail::common_kind<A, B>;
    using S = detail::part_of<A, B>;
    const S value = detail::value_of<S>(a) - detail::value_of<S>(b);
    if constexpr (detail::is_constant_beside<B, A>) {
        return D(value, a.derivative);
    } else if constexpr (detail::is_constant_beside<A, B>) {
        return D(value, -b.derivative);
    } else {
        return D(value, a.derivative - b.derivative);
    }
}

template <class A, class B>
requires detail::with_dual<A, B> MYRIAD_FUNCTION auto operator*(const A& a, const B& b) {
    using D = detail::common_kind<A, B>;
    using S = detail::part_of<A, B>;
    const S u = detail::value_of<S>(a);
    const S v = detail::value_of<S>(b);
    if constexpr (detail::is_constant_beside<B, A>) {
        return D(u * v, a.derivative * v);
    } else if constexpr (detail::is_constant_beside<A, B>) {
        return D(u * v, u * b.derivative);
    } else {
        return D(u * v, detail::product_rule(u, a.derivative, v, b.derivative));
    }
}

template <class A, class B>
requires detail::with_dual<A, B> MYRIAD_FUNCTION auto operator/(const A& a, const B& b) {
    using D = detail::common_kind<A, B>;
    using S = detail::part_of<A, B>;
    const S v = detail::value_of<S>(b);
    const S quotient = detail::value_of<S>(a) / v;
    if constexpr (detail::is_constant_beside<B, A>) {
        return D(quotient, a.derivative / v);
    } else if constexpr (detail::is_constant_beside<A, B>) {
        return D(quotient, detail::quotient_rule(quotient, v, b.derivative));
    } else {
        return D(quotient, detail::quotient_rule(quotient, a.derivative, v, b.derivative));
    }
}

#define MYRIAD_DUAL_COMPARISON(symbol)                                                              \
    template <class A, class B>                                                                     \
    requires detail::with_dual<A, B> MYRIAD_FUNCTION auto operator symbol(const A& a, const B& b) { \
        using S = detail::part_of<A, B>;                                                            \
        return detail::value_of<S>(a) symbol detail::value_of<S>(b);                                \
    }
MYRIAD_COMPARISONS(MYRIAD_DUAL_COMPARISON)
#undef MYRIAD_DUAL_COMPARISON

}  // namespace myriad::inline MYRIAD_TARGET

namespace myriad::detail::inline MYRIAD_TARGET {

template <class S, class Derivative>
struct vanishing_product<dual<S, Derivative>> {
    using D = dual<S, Derivative>;
    static MYRIAD_FUNCTION D of(const D& factor, const D& d) {
        return D(detail::scaled_unless_zero(factor.value, d.value),
                 detail::scaled_unless_zero(factor.value, d.derivative) +
                     detail::weighted_unless_zero(d.value, factor.derivative));
    }
};
template <class S, class Derivative>
struct vanishing_quotient<dual<S, Derivative>> {
    using D = dual<S, Derivative>;
    static MYRIAD_FUNCTION D of(const D& d, const D& by) {
        const S quotient = detail::quotient_unless_zero(d.value, by.value);
        return D(quotient, detail::quotient_unless_zero(
                               d.derivative - detail::weighted_unless_zero(quotient, by.derivative), by.value));
    }
};

// Where the slope of a function is infinite or NaN, as that of a square root at zero, a derivative is zero if that of
// the argument is: sqrt(max(x, 0)) has the derivative zero for x < 0. Sums, products and quotients do not ask for that,
// as they are too many.
template <class S, class Derivative>
struct functions<dual<S, Derivative>> {
    using D = dual<S, Derivative>;
    using f = functions<S>;
    using real = real_of<S>;

    static MYRIAD_FUNCTION S constant(real c) { return S(c); }

    static MYRIAD_FUNCTION D sqrt(const D& x) {
        const S root = f::sqrt(x.value);
        return D(root, detail::quotient_unless_zero(constant(real(0.5)) * x.derivative, root));
    }
    static MYRIAD_FUNCTION D cbrt(const D& x) {
        const S root = f::cbrt(x.value);
        return D(root, detail::quotient_unless_zero(x.derivative, constant(real(3)) * root * root));
    }
    static MYRIAD_FUNCTION D abs(const D& x) {
        return D(f::abs(x.value), select(x.value < real(0), -x.derivative, x.derivative));
    }
#define MYRIAD_DUAL_FUNCTION(name) \
    static MYRIAD_FUNCTION D name(const D& x) { return D(f::name(x.value)); }
    MYRIAD_STEP_FUNCTIONS(MYRIAD_DUAL_FUNCTION)
#undef MYRIAD_DUAL_FUNCTION

    static MYRIAD_FUNCTION D sin(const D& x) { return D(f::sin(x.value), x.derivative * f::cos(x.value)); }
    static MYRIAD_FUNCTION D cos(const D& x) { return D(f::cos(x.value), -x.derivative * f::sin(x.value)); }
    static MYRIAD_FUNCTION D tan(const D& x) {
        const S t = f::tan(x.value);
        return D(t, x.derivative * (constant(real(1)) + t * t));
    }
    static MYRIAD_FUNCTION S leg(const S& x) { return f::sqrt((constant(real(1)) - x) * (constant(real(1)) + x)); }
    static MYRIAD_FUNCTION D asin(const D& x) {
        return D(f::asin(x.value), detail::quotient_unless_zero(x.derivative, leg(x.value)));
    }
    static MYRIAD_FUNCTION D acos(const D& x) {
        return D(f::acos(x.value), detail::quotient_unless_zero(-x.derivative, leg(x.value)));
    }
    static MYRIAD_FUNCTION D atan(const D& x) {
        return D(f::atan(x.value), detail::flat_at(x, x.derivative / (constant(real(1)) + x.value * x.value)));
    }
    static MYRIAD_FUNCTION D sinpi(const D& x) {
        return D(f::sinpi(x.value), constant(pi) * x.derivative * f::cospi(x.value));
    }
    static MYRIAD_FUNCTION D cospi(const D& x) {
        return D(f::cospi(x.value), -constant(pi) * x.derivative * f::sinpi(x.value));
    }
    static MYRIAD_FUNCTION void sincos(const D& x, D& sine, D& cosine) {
        f::sincos(x.value, sine.value, cosine.value);
        sine.derivative = x.derivative * cosine.value;
        cosine.derivative = -x.derivative * sine.value;
    }
    static MYRIAD_FUNCTION void sincospi(const D& x, D& sine, D& cosine) {
        f::sincospi(x.value, sine.value, cosine.value);
        sine.derivative = constant(pi) * x.derivative * cosine.value;
        cosine.derivative = -constant(pi) * x.derivative * sine.value;
    }
    static MYRIAD_FUNCTION D rsqrt(const D& x) {
        const S r = f::rsqrt(x.value);
        return D(r, detail::flat_at(x, constant(real(-0.5)) * x.derivative * (r * r * r)));
    }
    static MYRIAD_FUNCTION D reciprocal(const D& x) {
        const S r = f::reciprocal(x.value);
        return D(r, detail::flat_at(x, -x.derivative * r * r));
    }

    static MYRIAD_FUNCTION D sinh(const D& x) { return D(f::sinh(x.value), x.derivative * f::cosh(x.value)); }
    static MYRIAD_FUNCTION D cosh(const D& x) { return D(f::cosh(x.value), x.derivative * f::sinh(x.value)); }
    static MYRIAD_FUNCTION D tanh(const D& x) {
        const S t = f::tanh(x.value);
        return D(t, detail::flat_at(x, x.derivative * (constant(real(1)) - t) * (constant(real(1)) + t)));
    }

    // Zero where the exponential is, as exp(n log(x)) at x = 0.
    static MYRIAD_FUNCTION D exp(const D& x) {
        const S e = f::exp(x.value);
        return D(e, detail::weighted_unless_zero(e, x.derivative));
    }
    static MYRIAD_FUNCTION D exp2(const D& x) {
        const S e = f::exp2(x.value);
        return D(e, detail::weighted_unless_zero(e, constant(ln_2) * x.derivative));
    }
    static MYRIAD_FUNCTION D log(const D& x) {
        return D(f::log(x.value), detail::quotient_unless_zero(x.derivative, x.value));
    }
    static MYRIAD_FUNCTION D log2(const D& x) {
        return D(f::log2(x.value), detail::quotient_unless_zero(constant(log2_e) * x.derivative, x.value));
    }
    static MYRIAD_FUNCTION D log10(const D& x) {
        return D(f::log10(x.value), detail::quotient_unless_zero(constant(log10_e) * x.derivative, x.value));
    }
    static MYRIAD_FUNCTION D expm1(const D& x) {
        return D(f::expm1(x.value), detail::weighted_unless_zero(f::exp(x.value), x.derivative));
    }
    static MYRIAD_FUNCTION D log1p(const D& x) {
        return D(f::log1p(x.value), detail::quotient_unless_zero(x.derivative, constant(real(1)) + x.value));
    }

    // y x^(y - 1), not y x^y / x, which is NaN at x = 0; x^0 has derivative zero there too.
    template <class B>
    static MYRIAD_FUNCTION D pow_of_base(const D& x, const B& exponent) {
        const S y = to_kind<S>(exponent);
        const S slope = y * f::pow(x.value, y - constant(real(1)));
        return by_base(f::pow(x.value, y), x, y, select(y == constant(real(0)), y, slope));
    }
    template <class B>
    static MYRIAD_FUNCTION D powr(const D& x, const B& exponent) {
        using E = without_derivative<S>;
        const E y = to_kind<E>(exponent), one(real(1));
        // here x^0 is 1, though powr(0, 0) is not
        const S slope = select(y == one, S(one), y * f::powr(x.value, y - one));
        return by_base(f::powr(x.value, y), x, S(y), slope);
    }
    template <class A>
    static MYRIAD_FUNCTION D pow_of_exponent(const A& base, const D& y) {
        const S x = to_kind<S>(base);
        const S power = f::pow(x, y.value);
        return D(power, of_exponent(power, x, y.derivative));
    }
    static MYRIAD_FUNCTION D pow(const D& x, const D& y) {
        const D of_base = pow_of_base(x, y.value);
        // With a constant exponent, the logarithm of a non-positive base must not spoil the result.
        return D(of_base.value, of_base.derivative + of_exponent(of_base.value, x.value, y.derivative));
    }
    static MYRIAD_FUNCTION D atan2(const D& y, const D& x) {
        const S square = x.value * x.value + y.value * y.value;
        return D(f::atan2(y.value, x.value),
                 detail::quotient_unless_zero(x.value * y.derivative - y.value * x.derivative, square));
    }
    static MYRIAD_FUNCTION D hypot(const D& x, const D& y) {
        const S length = f::hypot(x.value, y.value);
        return D(length, detail::quotient_unless_zero(x.value * x.derivative + y.value * y.derivative, length));
    }
    static MYRIAD_FUNCTION D copysign(const D& x, const D& sign) {
        const S one = constant(real(1));
        const auto kept = f::copysign(one, x.value) == f::copysign(one, sign.value);
        return D(f::copysign(x.value, sign.value), select(kept, x.derivative, -x.derivative));
    }
    static MYRIAD_FUNCTION D fmod(const D& x, const D& y) {
        const S rest = f::fmod(x.value, y.value);
        return D(rest, x.derivative - f::rint((x.value - rest) / y.value) * y.derivative);
    }
    // Selects as for the values, so that the derivative belongs to the number returned.
    static MYRIAD_FUNCTION D min(const D& a, const D& b) {
        return D(f::min(a.value, b.value), select(b.value != b.value || a.value < b.value, a.derivative, b.derivative));
    }
    static MYRIAD_FUNCTION D max(const D& a, const D& b) {
        return D(f::max(a.value, b.value), select(b.value != b.value || a.value > b.value, a.derivative, b.derivative));
    }
    static MYRIAD_FUNCTION D fma(const D& a, const D& b, const D& c) {
        return D(f::fma(a.value, b.value, c.value),
                 add_product(a.derivative, b.value, add_product(a.value, b.derivative, c.derivative)));
    }
    static MYRIAD_FUNCTION auto is_finite(const D& x) {
        return f::is_finite(x.value) && derivative_is_finite(x.derivative);
    }

private:
    // A power and its derivative by its base, which is zero also far out, if the power is next to zero there.
    static MYRIAD_FUNCTION D by_base(const S& power, const D& x, const S& exponent, const S& slope) {
        const real tiny = real(0x1p+64) / largest_of<S>;
        const S far = select(f::abs(exponent * power) < tiny, x.value, constant(real(0)));
        return D(power, detail::flat_far_out(far, x.derivative, detail::scaled_unless_zero(slope, x.derivative)));
    }
    // The derivative of a power by its exponent: zero where the power is, though its base has an infinite logarithm.
    static MYRIAD_FUNCTION Derivative of_exponent(const S& power, const S& base, const Derivative& d) {
        return detail::scaled_unless_zero(detail::weighted_unless_zero(power, f::log(base)), d);
    }
    static constexpr real pi = real(3.14159265358979323846L);
    static constexpr real ln_2 = real(0.693147180559945309417L);
    static constexpr real log2_e = real(1.44269504088896340736L);
    static constexpr real log10_e = real(0.434294481903251827651L);
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
