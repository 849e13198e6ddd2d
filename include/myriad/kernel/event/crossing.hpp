// SPDX-License-Identifier: MIT
// The crossing of an event function inside a step, from its values and slopes at both ends.
#pragma once

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/arithmetic.hpp"
#include "myriad/kernel/scalar/math.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// An event function at both ends of a step: values, and slopes per step. Signs are chosen so that it falls through
/// zero.
template <class R>
struct function_ends {
    R value, slope;
    R end_value, end_slope;
};

/// A redone step has arrived once the event function is within this part of its tolerance. Guesses for its length aim
/// closer, since the cubic is not exact.
inline constexpr double arrival_part = 0.1, guess_part = 0.01;

/// The root, 0 < x < 1, of the cubic a + x (b + x (c + x d)), which is positive at 0, or rises from zero there, and is
/// negative at 1: Newton's method, safeguarded by bisection, until the value is within `close` of zero. Six iterations
/// are enough for a guess. Returns 1/2 if the coefficients are not finite.
template <class R>
MYRIAD_RARE_FUNCTION R cubic_root(R a, R b, R c, R d, R close) {
    constexpr R last = R(1) - R(4) * epsilon_of<R>;
    R low = R(0), high = R(1);
    const R fall = a - (((a + b) + c) + d);  // from one end to the other
    R x = a * reciprocal(fall);              // the secant
    // Where it rises from zero, that secant would lead back to the start: those of the cubic without its root there.
    if (b >= R(0)) x = max(x, c > R(0) ? c * reciprocal(-d) : b * reciprocal(b + fall));
    MYRIAD_ROLLED
    for (int i = 0; i < 6; ++i) {
        if (!(x > low && x < high)) x = R(0.5) * (low + high);
        const R value = fma(x, fma(x, fma(x, d, c), b), a);
        const R slope = fma(x, fma(x, R(3) * d, R(2) * c), b);
        if (value != value) return R(0.5);
        if (value > R(0)) {
            low = x;
        } else {
            high = x;
        }
        const R step = value * reciprocal(slope);
        if (abs(step) <= R(4) * epsilon_of<R> * x) break;
        x -= step;
        if (abs(value) <= close) break;
    }
    if (!(x >= low && x <= high)) x = R(0.5) * (low + high);
    return x < last ? x : last;
}

/// The fraction of the step at which the function crosses zero, to within `close`: a root of the cubic through both
/// ends (Hairer, Norsett, Wanner, Solving ODE I, II.6, eq. (6.7)). Where it rises from its surface, that at which it
/// returns.
template <class R>
MYRIAD_FUNCTION R crossing_fraction(const function_ends<R>& g, R close) {
    const R rise = g.end_value - g.value;
    return detail::cubic_root(g.value, g.slope, R(3) * rise - R(2) * g.slope - g.end_slope,
                              g.slope + g.end_slope - R(2) * rise, close);
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
