// SPDX-License-Identifier: MIT
// Roots of a function of one variable in a bracket, for all lanes of a pack at once, each with its own bracket and
// stopping test.
#pragma once

#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// A bracket [low, high] with f(low) > 0 > f(high).
template <class S>
struct bracket {
    S low, high;
    S f_low, f_high;
};

/// Finds a root within the bracket by the Illinois variant of regula falsi (Dowell and Jarratt, BIT 11 (1971) 168-174),
/// with bisection where rounding puts the secant's point outside. `f(x, close)` returns the value at x and sets the
/// mask of lanes that are close enough; a lane whose bracket has shrunk to rounding returns its lower end, where f > 0.
/// Lanes outside `wanted` return `high`. Chosen over Brent and ITP for having the least state and no branches.
template <class S, class F>
MYRIAD_FUNCTION S find_root(bracket<S> b, const mask_of<S>& wanted, F&& f) {
    using R = real_of<S>;
    using mask = mask_of<S>;
    S root = b.high;
    mask open = wanted;
    S last_side = S(R(0));
    for (int i = 0; i < 64 && any(open); ++i) {
        const S secant = b.high - b.f_high * (b.high - b.low) / (b.f_high - b.f_low);
        const S x = select((secant > b.low) & (secant < b.high), secant, S(R(0.5)) * (b.low + b.high));
        mask close = mask(false);
        const S value = f(x, close);
        const mask found = open & close;
        const mask narrow = open & !found & (b.high - b.low <= S(R(4) * epsilon_of<R>) * b.high);
        root = select(found, x, select(narrow, b.low, root));
        open = open & !(found | narrow);
        const mask before = value > S(R(0));
        const S side = select(before, S(R(1)), S(R(-1)));
        const mask again = side == last_side;
        b.f_high = select(before, select(again, S(R(0.5)) * b.f_high, b.f_high), value);
        b.f_low = select(before, value, select(again, S(R(0.5)) * b.f_low, b.f_low));
        b.high = select(before, b.high, x);
        b.low = select(before, x, b.low);
        last_side = side;
    }
    return select(open, b.low, root);
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
