// SPDX-License-Identifier: MIT
// The linearly implicit method of Euler and Maruyama, for Ito equations with a stiff drift.
#pragma once

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/methods/stochastic_method.hpp"

namespace myriad {

/// y1 = y + x with x = h (f + h df/dt + J x) + g dW, for Ito equations with any noise and a stiff drift, whose Jacobian
/// is J: fixed steps, strong order 1/2 (1 if the noise is additive), weak order 1. One step of Newton's method for the
/// drift-implicit method of Euler and Maruyama, and the same where the drift is linear; the noise is taken at the
/// beginning of a step. Source: Kloeden and Platen, Numerical Solution of Stochastic Differential Equations (1992),
/// section 12.2; of the linear system, Hairer and Wanner, Solving ODE II, IV.7.
struct linearly_implicit_euler_maruyama {
    static constexpr int stages = 1;
    static constexpr int embedded_order = 0;
    static constexpr bool first_same_as_last = false;
    static constexpr double strong_order = 0.5;             ///< with which paths converge
    static constexpr double weak_order = 1;                 ///< with which means over paths converge
    static constexpr noise_taken noise = noise_taken::any;  ///< which it takes
    static constexpr bool uses_jacobian = true;             ///< of the drift

    /// The state at t1, which is t + h up to rounding; `slope` is the drift at (t, y).
    template <class Equation, class S, detail::extent n>
    MYRIAD_FUNCTION static vec<S, n> step(const Equation& equation, const S& t, const S& h, const S&,
                                          const vec<S, n>& y, const vec<S, n>& slope) {
        const vec<S, n> change = equation.implicit_change(t, h, y, slope, equation.noise(t, y));
        vec<S, n> y1;
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c) y1[c] = y[c] + change[c];
        return y1;
    }
};

}  // namespace myriad
