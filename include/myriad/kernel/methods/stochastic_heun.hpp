// SPDX-License-Identifier: MIT
// Heun's method for Stratonovich equations.
#pragma once

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/methods/stochastic_method.hpp"
#include "myriad/kernel/scalar/math.hpp"

namespace myriad {

/// The trapezoidal rule for drift and noise after a step of Euler and Maruyama, for Stratonovich equations: fixed
/// steps, strong order 1 if the noise is diagonal, commutative or additive, else 1/2; weak order 1. Source: Ruemelin,
/// SIAM J. Numer. Anal. 19 (1982) 604-613.
struct stochastic_heun {
    static constexpr int stages = 2;
    static constexpr int embedded_order = 0;
    static constexpr bool first_same_as_last = false;
    static constexpr double strong_order = 1;               ///< with which paths converge
    static constexpr double weak_order = 1;                 ///< with which means over paths converge
    static constexpr noise_taken noise = noise_taken::any;  ///< which it takes

    /// The state at t1, which is t + h up to rounding; `slope` is the drift at (t, y).
    template <class Equation, class S, detail::extent n>
    MYRIAD_FUNCTION static vec<S, n> step(const Equation& equation, const S& t, const S& h, const S& t1,
                                          const vec<S, n>& y, const vec<S, n>& slope) {
        const vec<S, n> noise = equation.noise(t, y);
        vec<S, n> predicted;
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c) predicted[c] = y[c] + fma(h, slope[c], noise[c]);
        const vec<S, n> slope_end = equation.drift(t1, predicted), noise_end = equation.noise(t1, predicted);
        const S half(real_of<S>(0.5));
        vec<S, n> y1;
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c)
            y1[c] = y[c] + half * fma(h, slope[c] + slope_end[c], noise[c] + noise_end[c]);
        return y1;
    }
};

}  // namespace myriad
