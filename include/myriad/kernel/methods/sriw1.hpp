// SPDX-License-Identifier: MIT
// The method SRIW1, for Ito equations with diagonal noise.
#pragma once

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/methods/stochastic_method.hpp"
#include "myriad/kernel/scalar/math.hpp"

namespace myriad {

/// A Runge-Kutta method for Ito equations with diagonal noise: strong order 3/2, with fixed steps, or with
/// `adaptive<sriw1>` adaptive ones. It needs no derivatives. Source: Roessler, SIAM J. Numer. Anal. 48 (2010) 922-952,
/// scheme SRIW1; its SRI1 is another, of order 1. The error estimate: after Rackauckas and Nie, Discrete Contin. Dyn.
/// Syst. B 22 (2017) 2731-2761.
struct sriw1 {
    static constexpr int stages = 2;
    static constexpr int embedded_order = 0;
    static constexpr bool first_same_as_last = false;
    static constexpr double strong_order = 1.5;                  ///< with which paths converge
    static constexpr double weak_order = 1.5;                    ///< with which means over paths converge
    static constexpr noise_taken noise = noise_taken::diagonal;  ///< which it takes
    static constexpr bool uses_integrals = true;                 ///< of the path over each step
    static constexpr bool estimates_error = true;                ///< for `adaptive`

    /// The state at t1, which is t + h up to rounding; `slope` is the drift at (t, y). If asked for the `error`, it is
    /// estimated in the mean over what the path may do, for one more evaluation of the drift: an estimate along the
    /// path would allow longer steps where the path moves little, and errors of the steps would not average out.
    template <class Equation, class S, detail::extent n, class... Error>
    MYRIAD_FUNCTION static vec<S, n> step(const Equation& equation, const S& t, const S& h, const S& t1,
                                          const vec<S, n>& y, const vec<S, n>& slope, Error&... error) {
        using R = real_of<S>;
        constexpr auto m = Equation::m;
        const S quarter(R(0.25)), half(R(0.5)), third(R(1.0 / 3)), length = abs(h), root = sqrt(length);
        const S t_quarter = fma(quarter, h, t);
        const vec<S, m>& dw = equation.increments;
        const vec<S, m> mean = equation.mean_increments(h);
        // The weights of the four stages for each process, of I(1), I(1,1) / sqrt(h), I(1,0) / h and I(1,1,1) / h.
        vec<S, m> roots, of_first, of_second, of_third, of_fourth;
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            const S square = dw[j] * dw[j], twice = half * (square - length) / root;
            const S thrice = dw[j] * (square / (S(R(6)) * length) - half);
            roots[j] = root;
            of_first[j] = S(R(2)) * (mean[j] - thrice) - dw[j] - twice;
            of_second[j] = third * fma(S(R(4)), dw[j] + twice - mean[j], S(R(5)) * thrice);
            of_third[j] = third * (S(R(2)) * (dw[j] - mean[j] - thrice) - twice);
            of_fourth[j] = thrice;
        }
        const vec<S, n> kick_first = equation.times(t, y, roots), drawn = equation.times(t, y, mean);
        vec<S, n> inside, second, last;
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c) {
            const S by_drift = h * slope[c];
            inside[c] = y[c] + fma(S(R(0.75)), by_drift, S(R(1.5)) * drawn[c]);
            second[c] = y[c] + fma(quarter, by_drift, half * kick_first[c]);
            last[c] = y[c] + (by_drift - kick_first[c]);
        }
        const vec<S, n> slope_inside = equation.drift(fma(S(R(0.75)), h, t), inside);
        const vec<S, n> kick_second = equation.times(t_quarter, second, roots),
                        kick_last = equation.times(t1, last, roots);
        vec<S, n> fourth;
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c)
            fourth[c] = y[c] + (fma(quarter * h, slope[c], half * kick_last[c]) +
                                fma(S(R(3)), kick_second[c], S(R(-5)) * kick_first[c]));
        const vec<S, n> first_noise = equation.times(t, y, of_first),
                        second_noise = equation.times(t_quarter, second, of_second),
                        third_noise = equation.times(t1, last, of_third),
                        fourth_noise = equation.times(t_quarter, fourth, of_fourth);
        vec<S, n> y1;
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c)
            y1[c] = y[c] + (fma(h * third, fma(S(R(2)), slope_inside[c], slope[c]), first_noise[c] + second_noise[c]) +
                            (third_noise[c] + fourth_noise[c]));
        if constexpr (sizeof...(Error) != 0) {
            const vec<S, n> kick_fourth = equation.times(t_quarter, fourth, roots),
                            kick = equation.spread(t, y, sqrt(length * third));
            vec<S, n> beside;
            MYRIAD_UNROLL_UP_TO(64, 16)
            for (int c = 0; c < MYRIAD_LENGTH(n); ++c) {
                const S by_drift = S(R(0.75)) * h * slope[c];
                beside[c] = y[c] + (by_drift + copysign(S(R(1.5)) * kick[c], by_drift));
            }
            const vec<S, n> slope_beside = equation.drift(fma(S(R(0.75)), h, t), beside);
            MYRIAD_UNROLL_UP_TO(64, 16)
            for (int c = 0; c < MYRIAD_LENGTH(n); ++c) {
                // The factors of I(1,0) / h and I(1,1,1) / h, which have variances h / 3 and h / 6.
                const S of_integral =
                    S(R(2)) * kick_first[c] - third * fma(S(R(4)), kick_second[c], S(R(2)) * kick_last[c]);
                const S of_cube = (kick_fourth[c] - S(R(2)) * kick_first[c]) +
                                  third * fma(S(R(5)), kick_second[c], S(R(-2)) * kick_last[c]);
                const S by_noise = sqrt(third * fma(of_integral, of_integral, S(R(0.5)) * of_cube * of_cube));
                ((error[c] = fma(S(R(2.0 / 3)), abs(h * (slope_beside[c] - slope[c])), by_noise)), ...);
            }
        }
        return y1;
    }
};

}  // namespace myriad
