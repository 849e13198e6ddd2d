// SPDX-License-Identifier: MIT
// One step of a method for stochastic equations: the increments of the path, and what methods ask of the equation.
#pragma once

#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/methods/stochastic_method.hpp"
#include "myriad/kernel/model/jacobian.hpp"
#include "myriad/kernel/model/lane.hpp"
#include "myriad/kernel/model/noise.hpp"
#include "myriad/kernel/model/path_of_team.hpp"
#include "myriad/kernel/scalar/dual.hpp"
#include "myriad/kernel/scalar/select.hpp"
#include "myriad/kernel/stepper/explicit_rk.hpp"
#include "myriad/kernel/stepper/rosenbrock.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The result of a trial step. `noise`, the part of the path that it covers, is set before, as the slope at its start.
template <class Method, class S, extent n>
requires stochastic_method<Method>
struct trial_step<Method, S, n> {
    vec<S, n> slope, y;
    path_interval<S> noise;

    MYRIAD_FUNCTION vec<S, n>& slope_start() { return slope; }
    MYRIAD_FUNCTION const vec<S, n>& slope_start() const { return slope; }
};

/// The same with an estimate of its error.
template <class Method, class S, extent n>
requires(stochastic_method<Method>&& Method::embedded_order > 0) struct trial_step<Method, S, n> {
    vec<S, n> slope, y, error;
    tree_interval<S> noise;

    MYRIAD_FUNCTION vec<S, n>& slope_start() { return slope; }
    MYRIAD_FUNCTION const vec<S, n>& slope_start() const { return slope; }
};
template <class Method, int row, class S>
requires stochastic_method<Method> MYRIAD_FUNCTION S error_factor(const S&) { return S(real_of<S>(1)); }
template <class Method, int row, class S, extent n>
requires stochastic_method<Method> MYRIAD_FUNCTION S error_sum(const trial_step<Method, S, n>& trial, int component) {
    return trial.error[component];
}

/// Of a Rosenbrock method what gives it the matrix I / h - J.
struct whole_step {
    struct coefficients {
        double gamma = 1;
    };
    static constexpr coefficients tableau() { return {}; }
};

/// What a method asks of an equation dy = f(t, y) dt + g(t, y) dW over one step, in which the increments dW are known.
template <class Model, class S, bool with_integrals = false>
struct noisy_equation {
    static constexpr auto n = n_state<Model>;
    static constexpr auto m = n_wiener<Model>;

    const inputs<Model, S>& p;
    vec<S, m> increments;
    vec<S, with_integrals ? m : 0> integrals;  // of W(s) - W(t) over the step

    /// f
    MYRIAD_FUNCTION vec<S, n> drift(const S& t, const vec<S, n>& y) const {
        return detail::evaluate_rhs<Model>(t, y, p);
    }
    /// The means of W(s) - W(t) over the step.
    MYRIAD_FUNCTION vec<S, m> mean_increments(const S& h) const {
        vec<S, m> mean;
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) mean[j] = integrals[j] / h;
        return mean;
    }
    /// g dW
    MYRIAD_FUNCTION vec<S, n> noise(const S& t, const vec<S, n>& y) const { return times(t, y, increments); }
    /// The product of g and one number for each process.
    MYRIAD_FUNCTION vec<S, n> times(const S& t, const vec<S, n>& y, const vec<S, m>& by) const {
        const auto g = Model::template diffusion<S>(t, y, p);
        vec<S, n> sum;
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c) {
            if constexpr (has_general_noise<Model>) {
                sum[c] = g[c][0] * by[0];
                MYRIAD_UNROLL_UP_TO(64, 16)
                for (int j = 1; j < MYRIAD_LENGTH(m); ++j) sum[c] = fma(g[c][j], by[j], sum[c]);
            } else {
                sum[c] = g[c] * by[c];
            }
        }
        return sum;
    }
    /// The deviations of g dW if that of each dW is the same.
    MYRIAD_FUNCTION vec<S, n> spread(const S& t, const vec<S, n>& y, const S& deviation) const {
        const auto g = Model::template diffusion<S>(t, y, p);
        vec<S, n> found;
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c) {
            if constexpr (has_general_noise<Model>) {
                S squares = g[c][0] * g[c][0];
                MYRIAD_UNROLL_UP_TO(64, 16)
                for (int j = 1; j < MYRIAD_LENGTH(m); ++j) squares = fma(g[c][j], g[c][j], squares);
                found[c] = deviation * sqrt(squares);
            } else {
                found[c] = deviation * abs(g[c]);
            }
        }
        return found;
    }
    /// g, a vector for each process: zero but for its own state if the noise is diagonal.
    MYRIAD_FUNCTION vec<vec<S, n>, m> columns(const S& t, const vec<S, n>& y) const {
        const auto g = Model::template diffusion<S>(t, y, p);
        vec<vec<S, n>, m> all;
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            MYRIAD_UNROLL_UP_TO(64, 16)
            for (int c = 0; c < MYRIAD_LENGTH(n); ++c) {
                if constexpr (has_general_noise<Model>) {
                    all[j][c] = g[c][j];
                } else {
                    all[j][c] = c == j ? g[c] : S(real_of<S>(0));
                }
            }
        }
        return all;
    }
    /// g dW + g g' (dW^2 - |h|) / 2 of diagonal noise, where g' is the derivative of a state's factor by that state:
    /// one evaluation with dual numbers gives all, as a factor depends on no other state.
    MYRIAD_FUNCTION vec<S, n> noise_with_correction(const S& t, const S& h, const vec<S, n>& y) const {
        if constexpr (is_additive<Model>) {
            return noise(t, y);
        } else {
            vec<dual<S>, n> seeded;
            MYRIAD_UNROLL_UP_TO(64, 16)
            for (int c = 0; c < MYRIAD_LENGTH(n); ++c) seeded[c] = dual<S>(y[c], S(real_of<S>(1)));
            const auto g = Model::template diffusion<dual<S>>(dual<S>(t), seeded, p);
            const S half(real_of<S>(0.5));
            vec<S, n> sum;
            MYRIAD_UNROLL_UP_TO(64, 16)
            for (int c = 0; c < MYRIAD_LENGTH(n); ++c) {
                const S dw = increments[c], excess = half * fma(dw, dw, -abs(h));
                sum[c] = g[c].value * fma(g[c].derivative, excess, dw);
            }
            return sum;
        }
    }
    /// The change x over a step of the equation that is linear in it, x = h (f + h df/dt + J x) + `noise`: f, which is
    /// `slope`, its derivative by time and the Jacobian J are those at (t, y). Not a number where I - h J is singular.
    MYRIAD_FUNCTION vec<S, n> implicit_change(const S& t, const S& h, const vec<S, n>& y, const vec<S, n>& slope,
                                              const vec<S, n>& noise) const {
        using loop = component_loop<Model, S>;
        const S per_h = detail::reciprocal_of_step(h);
        stage_factors<Model, S> lu;
        const auto regular = detail::factorise_stage_matrix<whole_step, Model>(t, per_h, y, p, lu);
        vec<S, n> change;
        loop::all([&](auto c) MYRIAD_LAMBDA { change[c] = fma(per_h, noise[c], slope[c]); });
        if constexpr (depends_on_time<Model>) {
            const vec<S, n> by_time = detail::time_derivative<Model>(t, y, p);
            loop::all([&](auto c) MYRIAD_LAMBDA { change[c] = fma(h, by_time[c], change[c]); });
        }
        solve_factorised(lu, change);
        loop::all([&](auto c) MYRIAD_LAMBDA { change[c] = select(regular, change[c], S(nan_of<real_of<S>>)); });
        return change;
    }
};

/// Steps from (t, y) by h to t1 along the path; `trial.slope` and `trial.noise` are given.
template <class Method, class Model, class S>
MYRIAD_FUNCTION void stochastic_step(const S& t, const S& h, const S& t1, const vec<S, n_state<Model>>& y,
                                     const inputs<Model, S>& p, trial_step<Method, S, n_state<Model>>& trial) {
    if constexpr (Method::embedded_order > 0) {
        const auto of_path = detail::integrals_of_model<Model>(trial.noise);
        const noisy_equation<Model, S, true> equation{p, of_path.increment, of_path.integral};
        trial.y = Method::step(equation, t, h, t1, y, trial.slope, trial.error);
    } else if constexpr (uses_integrals<Method>) {
        const auto of_path = detail::integrals_of_model<Model>(trial.noise);
        const noisy_equation<Model, S, true> equation{p, of_path.increment, of_path.integral};
        trial.y = Method::step(equation, t, h, t1, y, trial.slope);
    } else {
        const noisy_equation<Model, S> equation{p, detail::increments_of_model<Model>(trial.noise), {}};
        trial.y = Method::step(equation, t, h, t1, y, trial.slope);
    }
}

/// The state inside a step, at t + theta h: on the straight line between its ends. The path between them is not known,
/// and the mean of a bridge is that line.
template <class Step, class T>
MYRIAD_FUNCTION auto linear_interpolation(const Step& step, const T& theta) {
    return [&](int c) MYRIAD_LAMBDA { return fma(theta, step.trial.y[c] - step.y[c], step.y[c]); };
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
