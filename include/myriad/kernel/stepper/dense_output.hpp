// SPDX-License-Identifier: MIT
// The state inside a step: from the method's own interpolant if it has one, else from the cubic Hermite polynomial.
#pragma once

#include "myriad/kernel/methods/dense.hpp"
#include "myriad/kernel/stepper/step.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Stages that the interpolant needs besides the stages of the step and the slope at its end.
template <class Method>
inline constexpr int extra_stages = [] {
    if constexpr (requires { Method::extra_stages; }) {
        return Method::extra_stages;
    } else {
        return 0;
    }
}();
/// Stages of a method's own interpolant. Stage `stages` is the slope at the step's end, unless the last stage is it.
template <class Method>
inline constexpr int interpolant_stages = Method::stages + (extra_stages<Method> > 0 ? 1 + extra_stages<Method> : 0);
/// Whether an interpolant needs the slope at the end of the step in addition to the step's stages.
template <class Method>
inline constexpr bool interpolates_with_slope_end =
    !stochastic_method<Method> && (!has_own_interpolant<Method> || (extra_stages<Method> > 0));

/// Coefficient of theta^(power + 1) in the weight of a stage.
template <class Method, int stage, int power, class R>
inline constexpr R interpolant_weight = static_cast<R>(Method::interpolant_weight(stage, power));
/// Whether a stage contributes to the interpolant.
template <class Method, int stage>
inline constexpr bool interpolant_uses = [] {
    bool used = false;
    for (int power = 0; power < Method::interpolant_degree; ++power)
        used = used || Method::interpolant_weight(stage, power) != 0;
    return used;
}();
template <class Method, int i, class R>
inline constexpr R extra_node = static_cast<R>(Method::extra_node(i));
template <class Method, int i, int stage, class R>
inline constexpr R extra_weight = static_cast<R>(Method::extra_weight(i, stage));

/// Whether a step's interpolant has the solution's slopes at both ends, and these are available. A stiff method's
/// interpolant uses no slopes, as stiffness would spoil it.
template <class Method>
inline constexpr bool interpolates_between_slopes =
    !rosenbrock_method<Method> && (Method::first_same_as_last || interpolates_with_slope_end<Method>);

/// A trial step with the data that interpolants and event functions need.
template <class Method, class S, extent n>
struct step_data {
    S t;          // start
    S h;          // length
    vec<S, n> y;  // state at the start
    const trial_step<Method, S, n>& trial;
    vec<S, n> slope_end;                         // f at the end of the step
    vec<vec<S, n>, extra_stages<Method>> extra;  // additional stages, from complete_interpolant

    /// The slope at a stage of the interpolant.
    template <int stage>
    MYRIAD_FUNCTION const vec<S, n>& slope() const {
        if constexpr (stage < Method::stages) {
            return trial.k[stage];
        } else if constexpr (stage == Method::stages) {
            return slope_end;
        } else {
            return extra[stage - Method::stages - 1];
        }
    }
};

/// Evaluates the interpolant's own stages. The slope at the end of the step must be set.
template <class Model, class Method, class S, extent n>
MYRIAD_FUNCTION void complete_interpolant(step_data<Method, S, n>& step, const inputs<Model, S>& p) {
    using R = real_of<S>;
    static_for<0, extra_stages<Method>>([&](auto i) MYRIAD_LAMBDA {
        constexpr int own = decltype(i)::value;
        vec<S, n> argument = step.y;
        static_for<0, Method::stages + 1 + own>([&](auto j) MYRIAD_LAMBDA {
            constexpr int stage = decltype(j)::value;
            if constexpr (extra_weight<Method, own, stage, R> != R(0)) {
                const S scale = step.h * S(extra_weight<Method, own, stage, R>);
                MYRIAD_UNROLL
                for (int c = 0; c < MYRIAD_LENGTH(n); ++c)
                    argument[c] = fma(scale, step.template slope<stage>()[c], argument[c]);
            }
        });
        step.extra[own] = detail::evaluate_rhs<Model>(fma(S(extra_node<Method, own, R>), step.h, step.t), argument, p);
    });
}

/// The cubic with values y0, y1 and slopes k0, k1 at the ends of a step of length h, at fraction theta; for a dual
/// theta, with its derivative. Hairer, Norsett, Wanner, Solving ODE I, II.6, eq. (6.7).
template <class S, extent n, class T>
MYRIAD_FUNCTION vec<T, n> hermite_interpolation(const vec<S, n>& y0, const vec<S, n>& y1, const vec<S, n>& k0,
                                                const vec<S, n>& k1, const S& h, const T& theta) {
    using R = real_of<S>;
    vec<T, n> out;
    const T theta1 = theta - S(R(1));
    const T middle = S(R(1)) - theta - theta;
    MYRIAD_UNROLL
    for (int c = 0; c < MYRIAD_LENGTH(n); ++c) {
        const S difference = y1[c] - y0[c];
        const T slopes = fma(theta1, k0[c], theta * k1[c]);
        const T bend = fma(h, slopes, middle * difference);
        out[c] = fma(theta, fma(theta1, bend, difference), y0[c]);
    }
    return out;
}

/// State at t + theta h, 0 <= theta <= 1; for a dual theta, with its derivative.
template <class Method, class S, extent n, class T>
MYRIAD_FUNCTION vec<T, n> interpolate(const step_data<Method, S, n>& step, const T& theta) {
    using R = real_of<S>;
    vec<T, n> out;
    if constexpr (rosenbrock_method<Method>) {
        matrix_loop<S, n>::all([&](auto c) MYRIAD_LAMBDA {
            out[c] = detail::rosenbrock_interpolation<Method>(step.y, step.trial, theta, c);
        });
    } else if constexpr (has_own_interpolant<Method>) {
        constexpr int degree = Method::interpolant_degree, stages = interpolant_stages<Method>;
        vec<T, stages> weight;
        static_for<0, stages>([&](auto i) MYRIAD_LAMBDA {
            constexpr int stage = decltype(i)::value;
            if constexpr (interpolant_uses<Method, stage>) {
                T b = S(interpolant_weight<Method, stage, degree - 1, R>);
                static_for<1, degree>([&](auto power) MYRIAD_LAMBDA {
                    b = fma(b, theta, S(interpolant_weight<Method, stage, degree - 1 - decltype(power)::value, R>));
                });
                weight[i] = b * theta * step.h;
            }
        });
        MYRIAD_UNROLL
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c) {
            T increment = weight[0] * step.trial.k[0][c];
            static_for<1, stages>([&](auto i) MYRIAD_LAMBDA {
                constexpr int stage = decltype(i)::value;
                if constexpr (interpolant_uses<Method, stage>)
                    increment = fma(weight[i], step.template slope<stage>()[c], increment);
            });
            out[c] = step.y[c] + increment;
        }
    } else if constexpr (stochastic_method<Method>) {
        const auto inside = detail::linear_interpolation(step, theta);
        MYRIAD_UNROLL
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c) out[c] = inside(c);
    } else {
        out = detail::hermite_interpolation(step.y, step.trial.y, step.trial.slope_start(), step.slope_end, step.h,
                                            theta);
    }
    return out;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
