// SPDX-License-Identifier: MIT
// The state inside a step: the method's own interpolant where it has one, the cubic Hermite polynomial otherwise.
#pragma once

#include "myriad/stepper/explicit_rk.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// Coefficient of theta^(power + 1) in the weight of a stage.
template <class Method, int stage, int power, class R>
inline constexpr R interpolant_weight = static_cast<R>(Method::interpolant_weight(stage, power));

template <class Method>
inline constexpr bool has_own_interpolant = requires { Method::interpolant_degree; };

/// A trial step as the interpolants and event functions need it.
template <class Method, class S, int n>
struct step_data {
    S t;        // start
    S h;        // length
    vec<S, n> y;  // state at the start
    const rk_trial<Method, S, n>& trial;
    vec<S, n> slope_end;  // f at the end of the step
};

/// State at t + theta h, 0 <= theta <= 1. Hermite: Hairer, Norsett, Wanner, Solving ODE I, II.6, eq. (6.7).
template <class Method, class S, int n>
MYRIAD_FUNCTION vec<S, n> interpolate(const step_data<Method, S, n>& step, const S& theta) {
    using R = real_of<S>;
    vec<S, n> out;
    if constexpr (has_own_interpolant<Method>) {
        vec<S, Method::stages> weight;
        static_for<0, Method::stages>([&](auto i) MYRIAD_LAMBDA {
            constexpr int degree = Method::interpolant_degree;
            constexpr int stage = decltype(i)::value;
            S b = S(interpolant_weight<Method, stage, degree - 1, R>);
            static_for<1, degree>([&](auto power) MYRIAD_LAMBDA {
                b = fma(b, theta, S(interpolant_weight<Method, stage, degree - 1 - decltype(power)::value, R>));
            });
            weight[i] = b * theta * step.h;
        });
        MYRIAD_UNROLL
        for (int c = 0; c < n; ++c) {
            S increment = weight[0] * step.trial.k[0][c];
            static_for<1, Method::stages>(
                [&](auto i) MYRIAD_LAMBDA { increment = fma(weight[i], step.trial.k[i][c], increment); });
            out[c] = step.y[c] + increment;
        }
    } else {
        const S theta1 = theta - S(R(1));
        const S middle = S(R(1)) - theta - theta;
        MYRIAD_UNROLL
        for (int c = 0; c < n; ++c) {
            const S difference = step.trial.y[c] - step.y[c];
            const S slopes = fma(theta1, step.trial.k[0][c], theta * step.slope_end[c]);
            const S bend = fma(step.h, slopes, middle * difference);
            out[c] = fma(theta, fma(theta1, bend, difference), step.y[c]);
        }
    }
    return out;
}

}  // namespace myriad::inline MYRIAD_TARGET
