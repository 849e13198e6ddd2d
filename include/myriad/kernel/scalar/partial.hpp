// SPDX-License-Identifier: MIT
// Derivatives that know whether they are always zero, one or several at once: in a Jacobian by groups of columns most
// are, and those by a parameter of all the others; a compiler may not leave out 0 * x + y by itself, as x could be
// infinite.
#pragma once

#include <concepts>
#include <utility>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/scalar/select.hpp"

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

/// The derivatives of a dual number in several directions, each a `partial`. What all directions share, such as the
/// value and the slope of a function, is computed once.
template <class S, int count>
struct partials {
    partial<S> in[count];

    /// The derivatives `of(constant_index<i>{})`.
    template <class F>
    static MYRIAD_FUNCTION partials each(F&& of) {
        return [&]<int... i>(std::integer_sequence<int, i...>) MYRIAD_LAMBDA {
            return partials{{of(constant_index<i>{})...}};
        }
        (std::make_integer_sequence<int, count>{});
    }

    friend MYRIAD_FUNCTION partials operator-(const partials& a) {
        return each([&](auto i) MYRIAD_LAMBDA { return -a.in[i]; });
    }
    friend MYRIAD_FUNCTION partials operator+(const partials& a, const partials& b) {
        return each([&](auto i) MYRIAD_LAMBDA { return a.in[i] + b.in[i]; });
    }
    friend MYRIAD_FUNCTION partials operator-(const partials& a, const partials& b) {
        return each([&](auto i) MYRIAD_LAMBDA { return a.in[i] - b.in[i]; });
    }
    friend MYRIAD_FUNCTION partials operator*(const partials& a, const S& b) {
        return each([&](auto i) MYRIAD_LAMBDA { return a.in[i] * b; });
    }
    friend MYRIAD_FUNCTION partials operator*(const S& a, const partials& b) { return b * a; }
    /// By the reciprocal, which all directions share.
    friend MYRIAD_FUNCTION partials operator/(const partials& a, const S& b) { return a * functions<S>::reciprocal(b); }
    friend MYRIAD_FUNCTION partials select(const mask_of<S>& first, const partials& a, const partials& b) {
        return each([&](auto i) MYRIAD_LAMBDA { return select(first, a.in[i], b.in[i]); });
    }
    friend MYRIAD_FUNCTION partials add_product(const partials& a, const S& b, const partials& c) {
        return each([&](auto i) MYRIAD_LAMBDA { return add_product(a.in[i], b, c.in[i]); });
    }
    friend MYRIAD_FUNCTION partials add_product(const S& a, const partials& b, const partials& c) {
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

template <class S, int count>
struct derivative_of_constant<partials<S, count>> {
    static MYRIAD_FUNCTION partials<S, count> get() {
        return partials<S, count>::each([](auto) MYRIAD_LAMBDA { return partial<S>::none(); });
    }
};

/// The derivative of a product.
template <class S, class Derivative>
MYRIAD_FUNCTION Derivative product_rule(const S& u, const Derivative& du, const S& v, const Derivative& dv) {
    return du * v + u * dv;
}
template <class S, int count>
MYRIAD_FUNCTION partials<S, count> product_rule(const S& u, const partials<S, count>& du, const S& v,
                                                const partials<S, count>& dv) {
    return add_product(du, v, u * dv);
}

/// A derivative that is no number, with rules of its own beside numbers S: recorded.hpp.
template <class D, class S>
concept derivative_with_rules = std::same_as<typename D::follows_own_rules, S>;
template <class S, derivative_with_rules<S> D>
MYRIAD_FUNCTION D product_rule(const S& u, const D& du, const S& v, const D& dv) {
    return D::sum(v, du, u, dv);
}

/// Whether derivatives are finite.
template <class S>
MYRIAD_FUNCTION auto derivative_is_finite(const S& d) {
    return functions<S>::is_finite(d);
}
template <class S>
MYRIAD_FUNCTION auto derivative_is_finite(const partial<S>& d) {
    return functions<S>::is_finite(d.value);
}
template <class S, int count>
MYRIAD_FUNCTION auto derivative_is_finite(const partials<S, count>& d) {
    auto finite = functions<S>::is_finite(d.in[0].value);
    MYRIAD_UNROLL
    for (int i = 1; i < count; ++i) finite = finite & functions<S>::is_finite(d.in[i].value);
    return finite;
}

/// factor * d, but zero where d is, even if the factor is not finite. Of dual numbers, for which dual.hpp has another,
/// that holds of each product in it.
template <class S>
struct vanishing_product {
    static MYRIAD_FUNCTION S of(const S& factor, const S& d) { return select(d == S(real_of<S>(0)), d, factor * d); }
};
template <class S>
MYRIAD_FUNCTION S scaled_unless_zero(const S& factor, const S& d) {
    return vanishing_product<S>::of(factor, d);
}
template <class S>
MYRIAD_FUNCTION partial<S> scaled_unless_zero(const S& factor, const partial<S>& d) {
    return d.zero ? d : partial<S>(detail::scaled_unless_zero(factor, d.value));
}
template <class S, int count>
MYRIAD_FUNCTION partials<S, count> scaled_unless_zero(const S& factor, const partials<S, count>& d) {
    return partials<S, count>::each([&](auto i) MYRIAD_LAMBDA { return detail::scaled_unless_zero(factor, d.in[i]); });
}

template <class S, derivative_with_rules<S> D>
MYRIAD_FUNCTION D scaled_unless_zero(const S& factor, const D& d) {
    return factor * d;
}

/// weight * d, but zero where the weight is, even if d is not finite.
template <class S>
MYRIAD_FUNCTION S weighted_unless_zero(const S& weight, const S& d) {
    return detail::scaled_unless_zero(d, weight);
}
template <class S>
MYRIAD_FUNCTION partial<S> weighted_unless_zero(const S& weight, const partial<S>& d) {
    return d.zero ? d : partial<S>(detail::scaled_unless_zero(d.value, weight));
}
template <class S, int count>
MYRIAD_FUNCTION partials<S, count> weighted_unless_zero(const S& weight, const partials<S, count>& d) {
    return partials<S, count>::each([&](auto i)
                                        MYRIAD_LAMBDA { return detail::weighted_unless_zero(weight, d.in[i]); });
}

template <class S, derivative_with_rules<S> D>
MYRIAD_FUNCTION D weighted_unless_zero(const S& weight, const D& d) {
    return weight * d;
}

/// d / by, but zero where d is, even if by is zero.
template <class S>
struct vanishing_quotient {
    static MYRIAD_FUNCTION S of(const S& d, const S& by) { return select(d == S(real_of<S>(0)), d, d / by); }
};
template <class S>
MYRIAD_FUNCTION S quotient_unless_zero(const S& d, const S& by) {
    return vanishing_quotient<S>::of(d, by);
}
template <class S>
MYRIAD_FUNCTION partial<S> quotient_unless_zero(const partial<S>& d, const S& by) {
    return d.zero ? d : partial<S>(detail::quotient_unless_zero(d.value, by));
}
template <class S, int count>
MYRIAD_FUNCTION partials<S, count> quotient_unless_zero(const partials<S, count>& d, const S& by) {
    return detail::scaled_unless_zero(functions<S>::reciprocal(by), d);
}

template <class S, derivative_with_rules<S> D>
MYRIAD_FUNCTION D quotient_unless_zero(const D& d, const S& by) {
    return d / by;
}

/// 1 / x, also for infinite x, of which `reciprocal` on GPUs is NaN.
template <class S>
MYRIAD_FUNCTION S reciprocal_or_zero(const S& x) {
    const real_of<S> largest = largest_of<S>;
    return select(functions<S>::abs(x) > largest, S(real_of<S>(0)), functions<S>::reciprocal(x));
}

/// Whether a derivative is infinite; NaN is not.
template <class S>
MYRIAD_FUNCTION auto derivative_is_infinite(const S& d) {
    const real_of<S> largest = largest_of<S>;
    return functions<S>::abs(d) > largest;
}
template <class S>
MYRIAD_FUNCTION auto derivative_is_infinite(const partial<S>& d) {
    return detail::derivative_is_infinite(d.value);
}

/// Whether v has overflowed, or dv has and v nearly so.
template <class S, class Derivative>
MYRIAD_FUNCTION mask_of<S> has_overflowed(const S& v, const Derivative& dv) {
    const real_of<S> largest = largest_of<S>, huge = largest * real_of<S>(0x1p-32);
    const S size = functions<S>::abs(v);
    return (size > largest) | ((size > huge) & derivative_is_infinite(dv));
}

/// quotient' of quotient = u / v: (du - quotient dv) / v. Where v has overflowed, or dv has and v nearly so, dv does
/// not count: 1 / (1 + exp(c x)) has the derivative zero for large c x, which is its limit, and not NaN or infinite.
template <class S, class Derivative>
MYRIAD_FUNCTION Derivative weighted_unless_overflowed(const S& quotient, const S& v, const Derivative& dv) {
    return select(detail::has_overflowed(v, dv), derivative_of_constant<Derivative>::get(), Derivative(quotient * dv));
}
template <class S, int count>
MYRIAD_FUNCTION partials<S, count> weighted_unless_overflowed(const S& quotient, const S& v,
                                                              const partials<S, count>& dv) {
    return partials<S, count>::each(
        [&](auto i) MYRIAD_LAMBDA { return detail::weighted_unless_overflowed(quotient, v, dv.in[i]); });
}
template <class S, class Derivative>
MYRIAD_FUNCTION Derivative quotient_rule(const S& quotient, const Derivative& du, const S& v, const Derivative& dv) {
    return (du - detail::weighted_unless_overflowed(quotient, v, dv)) / v;
}
template <class S, class Derivative>
MYRIAD_FUNCTION Derivative quotient_rule(const S& quotient, const S& v, const Derivative& dv) {
    return -detail::weighted_unless_overflowed(quotient, v, dv) / v;
}
template <class S, int count>
MYRIAD_FUNCTION partials<S, count> quotient_rule(const S& quotient, const partials<S, count>& du, const S& v,
                                                 const partials<S, count>& dv) {
    return (du - detail::weighted_unless_overflowed(quotient, v, dv)) * detail::reciprocal_or_zero(v);
}
template <class S, int count>
MYRIAD_FUNCTION partials<S, count> quotient_rule(const S& quotient, const S& v, const partials<S, count>& dv) {
    return -detail::weighted_unless_overflowed(quotient, v, dv) * detail::reciprocal_or_zero(v);
}

/// d, the derivative of a function that becomes flat faster than its argument x grows, as tanh; but zero, its limit,
/// where x has overflowed, or dx has and x nearly so: there d may be a slope of zero times infinity.
template <class S, class Derivative>
MYRIAD_FUNCTION Derivative flat_far_out(const S& x, const Derivative& dx, const Derivative& d) {
    return select(detail::has_overflowed(x, dx), derivative_of_constant<Derivative>::get(), d);
}
template <class S, int count>
MYRIAD_FUNCTION partials<S, count> flat_far_out(const S& x, const partials<S, count>& dx, const partials<S, count>& d) {
    return partials<S, count>::each([&](auto i) MYRIAD_LAMBDA { return detail::flat_far_out(x, dx.in[i], d.in[i]); });
}
template <class S, derivative_with_rules<S> D>
MYRIAD_FUNCTION D flat_far_out(const S&, const D&, const D& d) {
    return d;
}
/// The same at a dual number.
template <class D, class Derivative>
MYRIAD_FUNCTION Derivative flat_at(const D& x, const Derivative& d) {
    return detail::flat_far_out(x.value, x.derivative, d);
}

/// a b + c
template <class S>
MYRIAD_FUNCTION S add_product(const S& a, const S& b, const S& c) {
    return functions<S>::fma(a, b, c);
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
