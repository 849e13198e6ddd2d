// SPDX-License-Identifier: MIT
// The method of Euler and Maruyama, for Ito equations with any noise.
#pragma once

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/methods/stochastic_method.hpp"
#include "myriad/kernel/scalar/math.hpp"

namespace myriad {

/// y1 = y + h f(t, y) + g(t, y) dW, for Ito equations with any noise: fixed steps, strong order 1/2 (1 if the noise is
/// additive), weak order 1. Source: Maruyama, Rend. Circ. Mat. Palermo 4 (1955) 48-90; Kloeden and Platen, Numerical
/// Solution of Stochastic Differential Equations (1992), section 10.2.
struct euler_maruyama {
    static constexpr int stages = 1;
    static constexpr int embedded_order = 0;
    static constexpr bool first_same_as_last = false;
    static constexpr double strong_order = 0.5;             ///< with which paths converge
    static constexpr double weak_order = 1;                 ///< with which means over paths converge
    static constexpr noise_taken noise = noise_taken::any;  ///< which it takes

    /// The state at t1, which is t + h up to rounding; `slope` is the drift at (t, y).
    template <class Equation, class S, detail::extent n>
    MYRIAD_FUNCTION static vec<S, n> step(const Equation& equation, const S& t, const S& h, const S&,
                                          const vec<S, n>& y, const vec<S, n>& slope) {
        const vec<S, n> noise = equation.noise(t, y);
        vec<S, n> y1;
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c) y1[c] = y[c] + fma(h, slope[c], noise[c]);
        return y1;
    }
};

}  // namespace myriad
