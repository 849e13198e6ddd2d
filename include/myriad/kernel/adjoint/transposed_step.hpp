// SPDX-License-Identifier: MIT
// The transpose of one step's derivative: from the derivatives of a loss by the state at a step's end to those by the
// state at its start and by parameters. A step is computed again from its recorded start, and then gone through
// backwards (Hager, Numer. Math. 87, 2000, 247-282; Griewank and Walther, Evaluating Derivatives, ch. 3). The length of
// a step counts as given.
//
// `Adjoint` is a model with products of transposed derivatives, where z is the state and then the n_wrt chosen
// parameters:
//     transposed_rhs(t, y, p, v)              (df/dz)^T v
//     transposed_slope(t, y, p, u, tau, v)    d(v^T (df/dy u + df/dt tau))/dz, for Rosenbrock methods
#pragma once

#include <array>
#include <cstddef>

#include "myriad/kernel/model/jacobian.hpp"
#include "myriad/kernel/stepper/dense_output.hpp"
#include "myriad/kernel/stepper/explicit_rk.hpp"
#include "myriad/kernel/stepper/rosenbrock.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Derivatives of a loss: by the state, and by the chosen parameters.
template <class Adjoint, class S>
struct loss_derivatives {
    static constexpr int n = n_state<Adjoint>, n_wrt = Adjoint::n_wrt;
    vec<S, n> state;
    vec<S, n_wrt> wrt;

    /// Takes what a product with a transposed derivative adds to both.
    MYRIAD_FUNCTION void add(const vec<S, n + n_wrt>& product) {
        for (int c = 0; c < n; ++c) state[c] = state[c] + product[c];
        for (int i = 0; i < n_wrt; ++i) wrt[i] = wrt[i] + product[n + i];
    }
};

/// The stages that the interpolant of an explicit method uses: those of the step, the slope at its end, and extra ones.
template <class Method>
struct stages_with_interpolant {
    static constexpr bool ends_with_slope = Method::first_same_as_last && extra_stages<Method> == 0;
    static constexpr bool more = interpolates_with_slope_end<Method> && !ends_with_slope;
    static constexpr int count = Method::stages + (more ? 1 + extra_stages<Method> : 0);
    static constexpr int slope_end = ends_with_slope ? Method::stages - 1 : Method::stages;
    /// Stages without the interpolant, of which the last, a slope at the end, may be for the next step alone.
    static constexpr int of_step = Method::first_same_as_last ? Method::stages - 1 : Method::stages;

    using row = std::array<double, static_cast<std::size_t>(count)>;
    /// Weights of the stages in the argument of stage i; row `count` has those of the solution.
    static constexpr auto weights = [] {
        std::array<row, static_cast<std::size_t>(count) + 1> all{};
        for (int i = 1; i <= count; ++i) {
            const bool of_solution = i == count, own = i < Method::stages;
            const int limit = own ? i : of_solution || i == Method::stages ? Method::stages : i;
            for (int j = 0; j < limit; ++j) {
                double& weight = all[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
                if (of_solution || i == Method::stages) {
                    weight = weight_in<Method>(Method::stages, j);
                } else if (own) {
                    weight = weight_in<Method>(i, j);
                } else if constexpr (extra_stages<Method> > 0) {
                    weight = Method::extra_weight(i - Method::stages - 1, j);
                }
            }
        }
        return all;
    }();
    static constexpr row nodes = [] {
        row all{};
        for (int i = 0; i < count; ++i) {
            double& node = all[static_cast<std::size_t>(i)];
            if (i < Method::stages) {
                node = Method::tableau().c[static_cast<std::size_t>(i)];
            } else if (i == Method::stages) {
                node = 1;
            } else if constexpr (extra_stages<Method> > 0) {
                node = Method::extra_node(i - Method::stages - 1);
            }
        }
        return all;
    }();
    /// The interpolant's weights of a stage, by powers of theta from the first on; Hermite's cubic has none here.
    static constexpr auto inside = [] {
        constexpr int degree = [] {
            if constexpr (has_own_interpolant<Method>) return Method::interpolant_degree;
            return 0;
        }();
        std::array<std::array<double, static_cast<std::size_t>(degree)>, static_cast<std::size_t>(count)> all{};
        if constexpr (has_own_interpolant<Method>)
            for (int i = 0; i < interpolant_stages<Method>; ++i)
                for (int power = 0; power < degree; ++power)
                    all[static_cast<std::size_t>(i)][static_cast<std::size_t>(power)] =
                        Method::interpolant_weight(i, power);
        return all;
    }();
};

/// A step of an explicit Runge-Kutta method, computed again, and its transpose.
template <class Adjoint, class Method, class S>
class transposed_step {
    using R = real_of<S>;
    using table = stages_with_interpolant<Method>;
    static constexpr int n = n_state<Adjoint>;

public:
    /// Computes the stages of the step from (t, y) by h, those of the interpolant too if it is used.
    MYRIAD_LARGE_FUNCTION void begin(const S& t, const S& h, const vec<S, n>& y, const inputs<Adjoint, S>& p,
                                     bool interpolates) {
        t_ = t, h_ = h;
        count_ = interpolates ? table::count : table::of_step;
        for (int i = 0; i < count_; ++i) {
            vec<S, n>& argument = argument_[i];
            argument = y;
            for (int j = 0; j < i; ++j) {
                if (weight(i, j) == R(0)) continue;
                const S scale = h * S(weight(i, j));
                for (int c = 0; c < n; ++c) argument[c] = fma(scale, k_[j][c], argument[c]);
            }
            k_[i] = detail::evaluate_rhs<Adjoint>(time_of(i), argument, p);
        }
        if (interpolates)
            for (int i = 0; i < count_; ++i) inside_[i] = {};
    }

    /// The state at t + theta h.
    MYRIAD_FUNCTION vec<S, n> interpolate(const vec<S, n>& y, const S& theta) const {
        vec<S, n> out = y;
        for (int i = 0; i < table::count; ++i) {
            const S weight = h_ * weight_inside(i, theta);
            for (int c = 0; c < n; ++c) out[c] = fma(weight, k_[i][c], out[c]);
        }
        return out;
    }
    /// Takes derivatives of the loss by the state there.
    MYRIAD_FUNCTION void add_inside(const S& theta, const vec<S, n>& g) {
        for (int i = 0; i < table::count; ++i) {
            const S weight = weight_inside(i, theta);
            for (int c = 0; c < n; ++c) inside_[i][c] = fma(weight, g[c], inside_[i][c]);
        }
    }

    /// Adds to the derivatives of the loss, which are those at the end of the step, what makes them those at its start.
    /// `end`: those by the state at the end.
    MYRIAD_LARGE_FUNCTION void transpose(const vec<S, n>& end, const inputs<Adjoint, S>& p, bool interpolates,
                                         loss_derivatives<Adjoint, S>& loss) {
        for (int i = count_ - 1; i >= 0; --i) {
            vec<S, n> v = interpolates ? inside_[i] : vec<S, n>{};
            const auto add = [&](R factor, const vec<S, n>& w) MYRIAD_LAMBDA {
                if (factor == R(0)) return;
                for (int c = 0; c < n; ++c) v[c] = fma(S(factor), w[c], v[c]);
            };
            add(weight(table::count, i), end);
            for (int j = i + 1; j < count_; ++j) add(weight(j, i), by_argument_[j]);
            for (int c = 0; c < n; ++c) v[c] = h_ * v[c];
            const auto product = Adjoint::template transposed_rhs<S>(time_of(i), argument_[i], p, v);
            for (int c = 0; c < n; ++c) by_argument_[i][c] = product[c];
            loss.add(product);
        }
    }

private:
    S t_, h_;
    int count_;
    vec<vec<S, n>, table::count> argument_, k_, by_argument_;
    vec<vec<S, n>, table::count> inside_;  // derivatives by h k from states inside the step

    static MYRIAD_FUNCTION R weight(int of, int j) {
        return static_cast<R>(table::weights[static_cast<std::size_t>(of)][static_cast<std::size_t>(j)]);
    }
    MYRIAD_FUNCTION S time_of(int i) const {
        return fma(S(static_cast<R>(table::nodes[static_cast<std::size_t>(i)])), h_, t_);
    }
    /// The weight of stage i in the interpolant, (y(t + theta h) - y) / h.
    static MYRIAD_FUNCTION S weight_inside(int i, const S& theta) {
        if constexpr (has_own_interpolant<Method>) {
            const auto& coefficients = table::inside[static_cast<std::size_t>(i)];
            S b = S(R(0));
            for (std::size_t power = coefficients.size(); power-- > 0;)
                b = fma(b, theta, S(static_cast<R>(coefficients[power])));
            return b * theta;
        } else {  // Hermite's cubic
            const S rest = S(R(1)) - theta, by_solution = theta * theta * fma(S(R(-2)), theta, S(R(3)));
            S b = by_solution * S(weight(table::count, i));
            if (i == 0) b = fma(theta * rest, rest, b);
            if (i == table::slope_end) b = fma(-theta * theta, rest, b);
            return b;
        }
    }
};

/// A step of a Rosenbrock method, whose stages are those of rosenbrock_tableau.hpp. Its matrix has derivatives of its
/// own.
template <class Adjoint, rosenbrock_method Method, class S>
class transposed_step<Adjoint, Method, S> {
    using R = real_of<S>;
    static constexpr int n = n_state<Adjoint>, stages = Method::stages;
    static constexpr auto table = Method::tableau();

public:
    MYRIAD_LARGE_FUNCTION void begin(const S& t, const S& h, const vec<S, n>& y, const inputs<Adjoint, S>& p,
                                     bool interpolates) {
        t_ = t, h_ = h, per_h_ = detail::reciprocal_of_step(h);
        detail::factorise_stage_matrix<Method, Adjoint>(t, per_h_, y, p, lu_);
        vec<S, n> slope_t = {};
        if constexpr (depends_on_time<Adjoint>) slope_t = detail::time_derivative<Adjoint>(t, y, p);
        for (int i = 0; i < stages; ++i) {
            argument_[i] = y;
            vec<S, n> coupled = {};
            for (int j = 0; j < i; ++j) {
                add(argument_[i], weight(i, j), u_[j]);
                add(coupled, coupling(i, j), u_[j]);
            }
            u_[i] = detail::evaluate_rhs<Adjoint>(time_of(i), argument_[i], p);
            for (int c = 0; c < n; ++c)
                u_[i][c] = fma(per_h_, coupled[c], fma(h_ * S(time_weight(i)), slope_t[c], u_[i][c]));
            solve_factorised(lu_, u_[i]);
        }
        if (interpolates)
            for (int i = 0; i < stages; ++i) inside_[i] = {};
    }
    MYRIAD_FUNCTION vec<S, n> interpolate(const vec<S, n>& y, const S& theta) const {
        vec<S, n> out = y;
        for (int i = 0; i < stages; ++i) {
            const S b = weight_inside(i, theta);
            for (int c = 0; c < n; ++c) out[c] = fma(b, u_[i][c], out[c]);
        }
        return out;
    }
    MYRIAD_FUNCTION void add_inside(const S& theta, const vec<S, n>& g) {
        for (int i = 0; i < stages; ++i) {
            const S b = weight_inside(i, theta);
            for (int c = 0; c < n; ++c) inside_[i][c] = fma(b, g[c], inside_[i][c]);
        }
    }
    MYRIAD_LARGE_FUNCTION void transpose(const vec<S, n>& end, const inputs<Adjoint, S>& p, bool interpolates,
                                         loss_derivatives<Adjoint, S>& loss) {
        for (int i = stages - 1; i >= 0; --i) {
            vec<S, n> coupled = {};
            v_[i] = interpolates ? inside_[i] : vec<S, n>{};
            add(v_[i], weight(stages, i), end);
            for (int j = i + 1; j < stages; ++j) {
                add(v_[i], weight(j, i), by_argument_[j]);
                add(coupled, coupling(j, i), v_[j]);
            }
            for (int c = 0; c < n; ++c) v_[i][c] = fma(per_h_, coupled[c], v_[i][c]);
            solve_transposed(lu_, v_[i]);
            const auto product = Adjoint::template transposed_rhs<S>(time_of(i), argument_[i], p, v_[i]);
            for (int c = 0; c < n; ++c) by_argument_[i][c] = product[c];
            loss.add(product);
            loss.add(Adjoint::template transposed_slope<S>(t_, argument_[0], p, u_[i], h_ * S(time_weight(i)), v_[i]));
        }
    }

private:
    S t_, h_, per_h_;
    stage_factors<Adjoint, S> lu_;
    vec<vec<S, n>, stages> argument_, u_, v_, by_argument_, inside_;

    static MYRIAD_FUNCTION R weight(int of, int j) { return static_cast<R>(table.weight(of, j)); }
    static MYRIAD_FUNCTION R coupling(int of, int j) {
        return static_cast<R>(table.coupling[static_cast<std::size_t>(of)][static_cast<std::size_t>(j)]);
    }
    static MYRIAD_FUNCTION R time_weight(int i) { return static_cast<R>(table.d[static_cast<std::size_t>(i)]); }
    MYRIAD_FUNCTION S time_of(int i) const {
        return fma(S(static_cast<R>(table.c[static_cast<std::size_t>(i)])), h_, t_);
    }
    static MYRIAD_FUNCTION void add(vec<S, n>& sum, R weight, const vec<S, n>& x) {
        if (weight == R(0)) return;
        for (int c = 0; c < n; ++c) sum[c] = fma(S(weight), x[c], sum[c]);
    }
    /// The weight of stage i in the interpolant, y(t + theta h) - y.
    static MYRIAD_FUNCTION S weight_inside(int i, const S& theta) {
        S bend = S(R(0));
        for (std::size_t r = table.dense.size(); r-- > 0;)
            bend = fma(bend, theta, S(static_cast<R>(table.dense[r][static_cast<std::size_t>(i)])));
        return theta * fma(S(R(1)) - theta, bend, S(weight(stages, i)));
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
