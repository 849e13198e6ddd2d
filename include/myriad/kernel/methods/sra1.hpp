// SPDX-License-Identifier: MIT
// The method SRA1, for equations with additive noise.
#pragma once

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/methods/stochastic_method.hpp"
#include "myriad/kernel/scalar/math.hpp"

namespace myriad {

/// A Runge-Kutta method for additive noise, for which Ito and Stratonovich equations are the same: strong order 3/2 and
/// weak order 2, with fixed steps, or with `adaptive<sra1>` adaptive ones. Source: Roessler, SIAM J. Numer. Anal. 48
/// (2010) 922-952; the error estimate: after Rackauckas and Nie, Discrete Contin. Dyn. Syst. B 22 (2017) 2731-2761.
struct sra1 {
    static constexpr int stages = 2;
    static constexpr int embedded_order = 0;
    static constexpr bool first_same_as_last = false;
    static constexpr double strong_order = 1.5;                  ///< with which paths converge
    static constexpr double weak_order = 2;                      ///< with which means over paths converge
    static constexpr noise_taken noise = noise_taken::additive;  ///< which it takes
    static constexpr bool uses_integrals = true;                 ///< of the path over each step
    static constexpr bool estimates_error = true;                ///< for `adaptive`

    /// The state at t1, which is t + h up to rounding; `slope` is the drift at (t, y). If asked for the `error`, it is
    /// estimated in the mean over what the path may do, for one more evaluation of the drift: an estimate along the
    /// path would allow longer steps where the path moves little, and errors of the steps would not average out.
    template <class Equation, class S, detail::extent n, class... Error>
    MYRIAD_FUNCTION static vec<S, n> step(const Equation& equation, const S& t, const S& h, const S& t1,
                                          const vec<S, n>& y, const vec<S, n>& slope, Error&... error) {
        using R = real_of<S>;
        // of the mean of W - W(t) over the step, and of what the increment has more
        const auto mean = equation.mean_increments(h);
        const vec<S, n> at_end = equation.times(t1, y, mean);
        vec<S, n> inside;
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c)
            inside[c] = y[c] + fma(S(R(0.75)) * h, slope[c], S(R(1.5)) * at_end[c]);
        const vec<S, n> slope_inside = equation.drift(fma(S(R(0.75)), h, t), inside);
        const vec<S, n> whole = equation.times(t1, y, equation.increments), at_begin = equation.times(t, y, mean);
        const S third(R(1.0 / 3)), two_thirds(R(2.0 / 3));
        vec<S, n> y1;
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c)
            y1[c] =
                y[c] + fma(h, fma(third, slope[c], two_thirds * slope_inside[c]), whole[c] + (at_begin[c] - at_end[c]));
        if constexpr (sizeof...(Error) != 0) {
            const S deviation = sqrt(abs(h) * third);  // of the mean of W - W(t)
            const vec<S, n> kick = equation.spread(t1, y, deviation);
            vec<S, n> beside;
            MYRIAD_UNROLL_UP_TO(64, 16)
            for (int c = 0; c < MYRIAD_LENGTH(n); ++c) {
                const S by_drift = S(R(0.75)) * h * slope[c];
                beside[c] = y[c] + (by_drift + copysign(S(R(1.5)) * kick[c], by_drift));
            }
            const vec<S, n> slope_beside = equation.drift(fma(S(R(0.75)), h, t), beside),
                            begin = equation.spread(t, y, deviation);
            MYRIAD_UNROLL_UP_TO(64, 16)
            for (int c = 0; c < MYRIAD_LENGTH(n); ++c)
                ((error[c] = fma(two_thirds, abs(h * (slope_beside[c] - slope[c])), abs(begin[c] - kick[c]))), ...);
        }
        return y1;
    }
};

}  // namespace myriad
