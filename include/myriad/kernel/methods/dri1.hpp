// SPDX-License-Identifier: MIT
// The method DRI1, for means over the paths of Ito equations with any noise.
#pragma once

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/methods/stochastic_method.hpp"
#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad {

/// A Runge-Kutta method for Ito equations with any noise: fixed steps, weak order 2, and 3 without noise. It needs no
/// derivatives. It is for means over many paths alone: of an increment over a step it takes no more than in which of
/// six intervals that lies, and so paths do not converge. Source: Debrabant and Roessler, Appl. Numer. Math. 59 (2009)
/// 582-594; a sign for each pair of processes as in Kloeden and Platen, Numerical Solution of Stochastic Differential
/// Equations (1992), section 14.2.
struct dri1 {
    static constexpr int stages = 3;
    static constexpr int embedded_order = 0;
    static constexpr bool first_same_as_last = false;
    static constexpr double strong_order = 0;               ///< with which paths converge: they do not
    static constexpr double weak_order = 2;                 ///< with which means over paths converge
    static constexpr noise_taken noise = noise_taken::any;  ///< which it takes

    /// The state at t1, which is t + h up to rounding; `slope` is the drift at (t, y).
    template <class Equation, class S, detail::extent n>
    MYRIAD_FUNCTION static vec<S, n> step(const Equation& equation, const S& t, const S& h, const S& t1,
                                          const vec<S, n>& y, const vec<S, n>& slope) {
        using R = real_of<S>;
        constexpr auto m = Equation::m;
        const S half(R(0.5)), root = sqrt(abs(h));
        // In place of each increment / sqrt(h) the three-point number 0 or +-sqrt(3), with probabilities 2/3 and 1/6,
        // and the sign +-1, independent of it: both by where the increment lies between quantiles of its distribution.
        // The product of two signs is the pair's; these products are uncorrelated, as one sign for all pairs of a
        // process would not be.
        vec<S, m> three_point, sign;
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            const S z = equation.increments[j], size = abs(z);
            const auto beyond = size > S(R(0.96742156610170104)) * root;  // of probability 1/3
            const S whether = select(beyond, size - S(R(1.3829941271006384)) * root, z);
            three_point[j] = select(beyond, copysign(S(R(1.7320508075688772)), z), S(R(0)));
            sign[j] = copysign(S(R(1)), whether);
        }
        const vec<vec<S, n>, m> g = equation.columns(t, y);
        vec<S, n> noise, inside;
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c) {
            noise[c] = g[0][c] * three_point[0];
            MYRIAD_UNROLL_UP_TO(64, 16)
            for (int j = 1; j < MYRIAD_LENGTH(m); ++j) noise[c] = fma(g[j][c], three_point[j], noise[c]);
            noise[c] = root * noise[c];
            inside[c] = y[c] + fma(half * h, slope[c], S(R(0.35505102572168219)) * noise[c]);  // (6 - sqrt(6)) / 10
        }
        const vec<S, n> slope_inside = equation.drift(fma(half, h, t), inside);
        vec<S, n> y1;
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c)
            y1[c] = y[c] + fma(h, fma(S(R(2)), slope_inside[c], -slope[c]),
                               S(R(1.5797958971132712)) * noise[c]);  // (3 + 2 sqrt(6)) / 5
        const vec<S, n> slope_end = equation.drift(t1, y1);
        const S sixth(R(1.0 / 6)), two_thirds(R(2.0 / 3)), part(R(342.0 / 491));
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c)
            y1[c] = y[c] + h * fma(two_thirds, slope_inside[c], sixth * (slope[c] + slope_end[c]));
        // The factors of each process, to both sides along themselves; `kick` is what displaces other processes.
        const S t_inside = fma(part, h, t), aside = S(R(0.83458832858346356)) * root;  // 3 sqrt(38 / 491)
        vec<vec<S, n>, m> kick;
        MYRIAD_UNROLL_UP_TO(8, 4)
        for (int k = 0; k < MYRIAD_LENGTH(m); ++k) {
            vec<S, n> above, below;
            MYRIAD_UNROLL_UP_TO(64, 16)
            for (int c = 0; c < MYRIAD_LENGTH(n); ++c) {
                const S drifted = fma(part * h, slope[c], y[c]);
                above[c] = fma(aside, g[k][c], drifted);
                below[c] = fma(-aside, g[k][c], drifted);
            }
            const vec<S, n> up = equation.columns(t_inside, above)[k], down = equation.columns(t_inside, below)[k];
            const S of_first = root * three_point[k];
            const S of_difference = S(R(0.29954888109245658)) * root *  // sqrt(491 / 38) / 12
                                    fma(three_point[k], three_point[k], S(R(-1)));
            MYRIAD_UNROLL_UP_TO(64, 16)
            for (int c = 0; c < MYRIAD_LENGTH(n); ++c) {
                const S sum = up[c] + down[c];
                const S mean = fma(S(R(193.0 / 684)), g[k][c], S(R(491.0 / 1368)) * sum);
                y1[c] = y1[c] + fma(of_first, mean, of_difference * (up[c] - down[c]));
                kick[k][c] = fma(S(R(-0.44049473309100519)), g[k][c],  // 214 / 513 sqrt(1105 / 991)
                                 S(R(-0.20213356443708743)) * sum);    // 491 / 513 sqrt(221 / 4955)
            }
        }
        if constexpr (m != 1) {
            MYRIAD_UNROLL_UP_TO(8, 4)
            for (int k = 0; k < MYRIAD_LENGTH(m); ++k) {
                vec<S, n> displaced{}, above, below;
                MYRIAD_UNROLL_UP_TO(8, 4)
                for (int l = 0; l < MYRIAD_LENGTH(m); ++l) {
                    if (l == k) continue;
                    // of the iterated integral of the two processes, / sqrt(h)
                    const S pair = l < k ? sign[k] * sign[l] : -(sign[k] * sign[l]);
                    const S weight = half * root * fma(three_point[k], three_point[l], pair);
                    MYRIAD_UNROLL_UP_TO(64, 16)
                    for (int c = 0; c < MYRIAD_LENGTH(n); ++c) displaced[c] = fma(weight, kick[l][c], displaced[c]);
                }
                MYRIAD_UNROLL_UP_TO(64, 16)
                for (int c = 0; c < MYRIAD_LENGTH(n); ++c) {
                    above[c] = y[c] + displaced[c];
                    below[c] = y[c] - displaced[c];
                }
                const vec<S, n> up = equation.columns(t, above)[k], down = equation.columns(t, below)[k];
                const S of_first = root * three_point[k];
                const S of_difference = S(R(-0.59188278083108981)) * root;  // sqrt(4955 / 221) / 8
                MYRIAD_UNROLL_UP_TO(64, 16)
                for (int c = 0; c < MYRIAD_LENGTH(n); ++c) {
                    const S bend = S(R(4955.0 / 14144)) * ((up[c] - g[k][c]) + (down[c] - g[k][c]));
                    y1[c] = y1[c] + fma(of_first, bend, of_difference * (up[c] - down[c]));
                }
            }
        }
        return y1;
    }
};

}  // namespace myriad
