// SPDX-License-Identifier: MIT
// The earliest crossing within a step: the first guess for the length of the redone step.
#pragma once

#include <cstdint>

#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/event/crossing.hpp"
#include "myriad/kernel/event/step_ends.hpp"
#include "myriad/kernel/scalar/mask_set.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// A crossing inside a step.
template <class R>
struct located_crossing {
    R fraction;          // of the step
    std::int32_t event;  // whose function crosses there
};

/// The earliest of the events in `crossed`, by the fractions `fraction_of(j)`; of equal ones the first by index.
template <class R, extent m, class Fraction>
MYRIAD_FUNCTION located_crossing<R> first_of(const mask_set<bool, m>& crossed, Fraction&& fraction_of) {
    located_crossing<R> first{R(2), 0};
    MYRIAD_UNROLL
    for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
        if (!crossed[j]) continue;
        const R x = fraction_of(j);
        if (x < first.fraction) first = {x, j};
    }
    return first;
}

/// Element j by comparisons, so that a GPU thread's vector stays in registers: nvcc would put it into memory for an
/// index that varies, and for a loop here, too.
template <class R, extent m>
MYRIAD_FUNCTION R element(const vec<R, m>& values, int j) {
    if constexpr (m > MYRIAD_MOST_COPIES) {
        return values[j];
    } else {
        R value = values[0];
        static_for<1, m>([&](auto k) MYRIAD_LAMBDA {
            const R other = values[k];
            if (j == k) value = other;
        });
        return value;
    }
}

/// The fraction of a step at which an event function crosses, from the cubic through its values and slopes at both
/// ends, which have the signs of a function that falls. One whose sign at the start is not that of its side, as right
/// after its event, crosses there if it goes on, and where it returns if it goes to its side. Without a slope it goes
/// on if it has `left` the surface since its event, and has come to it again. Of one that rises, small values
/// do not show that the crossing is near.
template <class R>
MYRIAD_FUNCTION R fraction_at(const function_ends<R>& g, bool left, R close) {
    if (!(g.value > R(0)) && (g.slope < R(0) || (left && g.slope == R(0)))) return R(0);
    return detail::crossing_fraction(g, g.slope > R(0) ? R(0) : R(guess_part) * close);
}

/// The earliest crossing in a step. `side` is the side of zero each function was on, and `tolerance` how closely the
/// crossing is to be located.
template <class Model, class R>
MYRIAD_FUNCTION located_crossing<R> earliest_crossing(const step_ends<Model, R>& step,
                                                      const vec<R, n_event<Model>>& side,
                                                      const mask_set<bool, n_event<Model>>& crossed,
                                                      const mask_set<bool, n_event<Model>>& left,
                                                      const vec<R, n_event<Model>>& tolerance) {
    const auto slope = step.slopes(), slope1 = step.slopes1();
    return detail::first_of<R>(crossed, [&](int j) MYRIAD_LAMBDA {
        const R per_step = side[j] * step.h;
        return detail::fraction_at<R>(
            {side[j] * step.g[j], per_step * slope[j], side[j] * step.g1[j], per_step * slope1[j]}, left[j],
            tolerance[j]);
    });
}

/// The same if just one function has crossed. Threads of a warp with different ones stay together.
template <class Model, class R>
MYRIAD_FUNCTION located_crossing<R> only_crossing(const step_ends<Model, R>& step, const vec<R, n_event<Model>>& side,
                                                  const mask_set<bool, n_event<Model>>& crossed,
                                                  const mask_set<bool, n_event<Model>>& left,
                                                  const vec<R, n_event<Model>>& tolerance) {
    const auto slope = step.slopes(), slope1 = step.slopes1();
    std::int32_t j = 0;
    if constexpr (n_event < Model >> MYRIAD_MOST_COPIES) {
        for (int k = 1; k < MYRIAD_LENGTH(n_event<Model>); ++k)
            if (crossed[k]) j = k;
    } else {
        static_for<1, n_event<Model>>([&](auto k) MYRIAD_LAMBDA {
            if (crossed[k]) j = k;
        });
    }
    const R sign = detail::element(side, j), per_step = sign * step.h;
    const R fraction =
        detail::fraction_at<R>({sign * detail::element(step.g, j), per_step * detail::element(slope, j),
                                sign * detail::element(step.g1, j), per_step * detail::element(slope1, j)},
                               left[j], tolerance[j]);
    return {fraction, j};
}

/// The same for crossings found between the fractions `low` and `high` of a step, by the secants between these points.
template <class Model, class R>
MYRIAD_FUNCTION located_crossing<R> earliest_crossing_between(R low, R high, const step_ends<Model, R>& step,
                                                              const mask_set<bool, n_event<Model>>& crossed) {
    const auto g = step.values_at(low), g1 = high < R(1) ? step.values_at(high) : step.g1;
    return detail::first_of<R>(crossed, [&](int j) MYRIAD_LAMBDA {
        // A function that is not on the other side at `low` is about to leave the surface and return.
        const bool opposite = (g[j] > R(0) && g1[j] < R(0)) || (g[j] < R(0) && g1[j] > R(0));
        return fma(high - low, opposite ? g[j] / (g[j] - g1[j]) : R(0.5), low);
    });
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
