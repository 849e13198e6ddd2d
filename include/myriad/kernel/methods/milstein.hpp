// SPDX-License-Identifier: MIT
// The method of Milstein, for Ito equations with diagonal noise.
#pragma once

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/methods/stochastic_method.hpp"
#include "myriad/kernel/scalar/math.hpp"

namespace myriad {

/// y1 = y + h f + g dW + g g' (dW^2 - h) / 2, for Ito equations with diagonal noise: fixed steps, strong order 1, weak
/// order 1. The derivative g' comes from dual numbers. Source: Milstein, Theory Probab. Appl. 19 (1975) 557-562;
/// Kloeden and Platen, Numerical Solution of Stochastic Differential Equations (1992), section 10.3.
struct milstein {
    static constexpr int stages = 1;
    static constexpr int embedded_order = 0;
    static constexpr bool first_same_as_last = false;
    static constexpr double strong_order = 1;                    ///< with which paths converge
    static constexpr double weak_order = 1;                      ///< with which means over paths converge
    static constexpr noise_taken noise = noise_taken::diagonal;  ///< which it takes

    /// The state at t1, which is t + h up to rounding; `slope` is the drift at (t, y).
    template <class Equation, class S, detail::extent n>
    MYRIAD_FUNCTION static vec<S, n> step(const Equation& equation, const S& t, const S& h, const S&,
                                          const vec<S, n>& y, const vec<S, n>& slope) {
        const vec<S, n> noise = equation.noise_with_correction(t, h, y);
        vec<S, n> y1;
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c) y1[c] = y[c] + fma(h, slope[c], noise[c]);
        return y1;
    }
};

}  // namespace myriad
