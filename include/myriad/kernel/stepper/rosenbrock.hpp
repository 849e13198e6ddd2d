// SPDX-License-Identifier: MIT
// One trial step of a Rosenbrock method, for stiff systems: Jacobian and time derivative, one LU factorisation, and a
// linear solve in each stage.
#pragma once

#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/methods/rosenbrock_tableau.hpp"
#include "myriad/kernel/methods/weights.hpp"
#include "myriad/kernel/model/jacobian.hpp"
#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/scalar/select.hpp"
#include "myriad/kernel/stepper/explicit_rk.hpp"
#include "myriad/kernel/stepper/lu.hpp"
#include "myriad/kernel/stepper/sparse_lu.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The results of a trial step: the slope at its start (and at its end, if the last stage computes it), the stages u,
/// the new state, and the lanes whose matrix was singular, where everything else is invalid.
template <class Method, class S, extent n>
requires rosenbrock_method<Method>
struct trial_step<Method, S, n> {
    static_assert(Method::embedded_order > 0, "a lane with a singular matrix needs a method that can shorten its step");
    static constexpr bool estimates_error = [] {
        const auto weights = Method::tableau().e;  // a temporary of the loop's would be no constant to NVRTC
        for (const double w : weights)
            if (w != 0) return true;
        return false;
    }();
    static_assert(
        estimates_error,
        "the method's tableau has no error weights e, with which it would accept every step: tableau() must set them");
    vec<vec<S, n>, Method::first_same_as_last ? 2 : 1> k;
    vec<vec<S, n>, Method::stages> u;
    vec<S, n> y;
    mask_of<S> singular;

    MYRIAD_FUNCTION vec<S, n>& slope_start() { return k[0]; }
    MYRIAD_FUNCTION const vec<S, n>& slope_start() const { return k[0]; }
    MYRIAD_FUNCTION const vec<S, n>& slope_end() const { return k[1]; }
};

// The tableau's entries as constants, since device code may not call the functions that compute them.

enum class rosenbrock_row { argument, coupling, error, dense };

template <class Method>
constexpr double rosenbrock_coefficient(rosenbrock_row kind, int row, int j) {
    const auto t = Method::tableau();
    const auto i = static_cast<std::size_t>(row), stage = static_cast<std::size_t>(j);
    switch (kind) {
        case rosenbrock_row::argument:
            return t.weight(row, j);
        case rosenbrock_row::coupling:
            return t.coupling[i][stage];
        case rosenbrock_row::error:
            return t.e[stage];
        default:
            return t.dense[i][stage];
    }
}
template <class Method, class R>
inline constexpr R reciprocal_gamma = static_cast<R>(1 / Method::tableau().gamma);
template <class Method, int i, class R>
inline constexpr R rosenbrock_time_weight = static_cast<R>(Method::tableau().d[static_cast<std::size_t>(i)]);
template <class Method>
inline constexpr int dense_terms = static_cast<int>(Method::tableau().dense.size());

/// First stage whose weight in the argument of stage `row` differs from that in the previous argument: stiffly accurate
/// methods repeat a row and extend it, and the repeated sum is reused.
template <class Method, int row>
inline constexpr int first_new_stage = [] {
    int j = 0;
    while (j < row - 1 && Method::tableau().weight(row, j) == Method::tableau().weight(row - 1, j)) ++j;
    return j == row - 1 ? j : 0;
}();

/// Whether the solution is the argument of the last stage plus that stage, so that algebraic equations hold at the end
/// of a step as they do in its last stage.
template <class Method>
inline constexpr bool is_stiffly_accurate = first_new_stage<Method, Method::stages> == Method::stages - 1 &&
                                            Method::tableau().weight(Method::stages, Method::stages - 1) == 1;

/// One row of weights of the given kind.
template <class Method>
constexpr auto rosenbrock_weights(rosenbrock_row kind, std::size_t row) {
    stage_numbers<Method::stages> w{};
    for (std::size_t j = 0; j < w.size(); ++j)
        w[j] = rosenbrock_coefficient<Method>(kind, static_cast<int>(row), static_cast<int>(j));
    return w;
}

/// The row sums of gamma, the response of a stage to a constant slope: exact, and with weights rounded to R.
template <class Method, class R>
inline constexpr auto rosenbrock_row_sums = [] {
    constexpr auto stages = static_cast<std::size_t>(Method::stages);
    struct {
        std::array<std::array<R, stages>, stages> coupling{};
        stage_numbers<stages> exact{}, kept{};
    } rows;
    for (std::size_t i = 0; i < stages; ++i) {
        const auto w = rosenbrock_weights<Method>(rosenbrock_row::coupling, i);
        rows.coupling[i] = rounded_weights<R>(w, 1, 0, i, rows.exact, {}, rows.kept, {});
        double exact = 1, kept = 1;
        for (std::size_t j = 0; j < i; ++j) {
            exact += w[j] * rows.exact[j];
            kept += static_cast<double>(rows.coupling[i][j]) * rows.kept[j];
        }
        rows.exact[i] = exact * Method::tableau().gamma;
        rows.kept[i] = kept / static_cast<double>(reciprocal_gamma<Method, R>);
    }
    return rows;
}();

/// One row of weights in the kernel's precision.
template <class Method, rosenbrock_row kind, int row, class R>
inline constexpr auto kept_rosenbrock_weights = [] {
    constexpr auto& sums = rosenbrock_row_sums<Method, R>;
    if constexpr (kind == rosenbrock_row::coupling) {
        return sums.coupling[static_cast<std::size_t>(row)];
    } else {
        // A row that a stiffly accurate method repeats is summed only once.
        constexpr int first = [] {
            if constexpr (kind == rosenbrock_row::argument) return first_new_stage<Method, row>;
            return 0;
        }();
        return rounded_weights<R>(rosenbrock_weights<Method>(kind, row), 1, first, Method::stages, sums.exact, {},
                                  sums.kept, {});
    }
}();
template <class Method, rosenbrock_row kind, int row, int j, class R>
inline constexpr R rosenbrock_weight = kept_rosenbrock_weights<Method, kind, row, R>[static_cast<std::size_t>(j)];

/// First stage with a non-zero weight.
template <class Method, rosenbrock_row kind, int row>
inline constexpr int first_weighted_stage = [] {
    int j = 0;
    while (rosenbrock_coefficient<Method>(kind, row, j) == 0) ++j;
    return j;
}();

/// sum + sum_j w_j u_j for one component, j from `begin` to `end`, without multiplications by zero and one.
template <class Method, rosenbrock_row kind, int row, int begin, int end, class T, class S, extent n>
MYRIAD_FUNCTION T add_stages(T sum, const vec<vec<S, n>, Method::stages>& u, int component) {
    using R = real_of<S>;
    static_for<begin, end>([&](auto j) MYRIAD_LAMBDA {
        constexpr R weight = rosenbrock_weight<Method, kind, row, decltype(j)::value, R>;
        if constexpr (weight == R(1)) {
            sum = sum + u[j][component];
        } else if constexpr (weight != R(0)) {
            sum = fma(S(weight), u[j][component], sum);
        }
    });
    return sum;
}

/// sum_j w_j u_j for one component, j from 0 to `end`.
template <class Method, rosenbrock_row kind, int row, int end, class S, extent n>
MYRIAD_FUNCTION S sum_stages(const vec<vec<S, n>, Method::stages>& u, int component) {
    using R = real_of<S>;
    constexpr int first = first_weighted_stage<Method, kind, row>;
    constexpr R weight = rosenbrock_weight<Method, kind, row, first, R>;
    const S sum = weight == R(1) ? u[first][component] : S(weight) * u[first][component];
    return detail::add_stages<Method, kind, row, first + 1, end>(sum, u, component);
}

/// The error estimate of one component: a sum, and its factor.
template <rosenbrock_method Method, int row = row_of<Method>::error, class S, extent n>
MYRIAD_FUNCTION S error_sum(const trial_step<Method, S, n>& trial, int component) {
    return detail::sum_stages<Method, rosenbrock_row::error, 0, Method::stages>(trial.u, component);
}
template <rosenbrock_method Method, int row = row_of<Method>::error, class S>
MYRIAD_FUNCTION S error_factor(const S&) {
    return S(real_of<S>(1));
}

/// Factorises I / (h gamma) - J; returns false in lanes where it is singular.
template <class Method, class Model, class S>
MYRIAD_FUNCTION mask_of<S> factorise_stage_matrix(const S& t, const S& per_h, const vec<S, n_state<Model>>& y,
                                                  const inputs<Model, S>& p, lu_factors<S, n_state<Model>>& lu) {
    using loop = matrix_loop<S, n_state<Model>>;
    detail::evaluate_jacobian<Model>(t, y, p, lu.a);
    const S shift = per_h * S(reciprocal_gamma<Method, real_of<S>>);
    loop::all([&](auto i) MYRIAD_LAMBDA {
        loop::all([&](auto j) MYRIAD_LAMBDA { lu.a[i][j] = -lu.a[i][j]; });
        if constexpr (!has_mass_matrix<Model>) lu.a[i][i] = shift + lu.a[i][i];
    });
    static_for<0, n_mass_entry<Model>>([&](auto m) MYRIAD_LAMBDA {
        constexpr int entry = decltype(m)::value, i = mass_row<Model, entry>, j = mass_column<Model, entry>;
        lu.a[i][j] = fma(S(mass_value<Model, entry, real_of<S>>), shift, lu.a[i][j]);
    });
    return factorise(lu);
}

/// The same for a matrix whose pattern is known; calls `keep(entry, value)` for each entry of the factors.
template <class Method, class Model, class S, class Keep = keep_nothing>
MYRIAD_FUNCTION mask_of<S> factorise_stage_matrix(const S& t, const S& per_h, const vec<S, n_state<Model>>& y,
                                                  const inputs<Model, S>& p, sparse_lu_factors<Model, S>& lu,
                                                  Keep&& keep = {}) {
    using lu_type = sparse_lu_factors<Model, S>;
    using tables = typename lu_type::tables;
    using loop = typename lu_type::loop;
    const S shift = per_h * S(reciprocal_gamma<Method, real_of<S>>);
    loop::template range<0, tables::n_entry>([&](auto e) MYRIAD_LAMBDA { lu.a[e] = S(real_of<S>(0)); });
    loop::template range<0, n_state<Model>>([&](auto i) MYRIAD_LAMBDA {
        if constexpr (has_mass_matrix<Model>) {
            lu.size[i] = S(real_of<S>(0));
        } else {
            lu.a[lu_type::template at<&tables::diagonal>(i)] = shift;
            lu.size[i] = abs(shift);
        }
    });
    static_for<0, n_mass_entry<Model>>([&](auto m) MYRIAD_LAMBDA {
        constexpr int entry = decltype(m)::value, i = mass_row<Model, entry>;
        constexpr int place = lu_tables_of<Model>.position[n_jacobian_entry<Model> + entry];
        const S term = S(mass_value<Model, entry, real_of<S>>) * shift;
        lu.a[place] = lu.a[place] + term;
        if constexpr (i == mass_column<Model, entry>) lu.size[i] = lu.size[i] + abs(term);
    });
    using entry_loop = table_loop<writes_out_jacobian<Model, S>>;
    detail::for_each_jacobian_entry<Model, entry_loop>(t, y, p, [&](auto e, const S& derivative) MYRIAD_LAMBDA {
        const auto place = entry_loop::template at<lu_tables_of<Model>, &tables::position>(e);
        const auto row = entry_loop::template at<lu_tables_of<Model>, &tables::pivot_row>(e);
        lu.a[place] = lu.a[place] - derivative;
        if (row >= 0) lu.size[row] = lu.size[row] + abs(derivative);
    });
    return factorise(lu, keep);
}
/// The same for factors whose matrix is known only when the model runs (`stage_factors_of`).
template <class Method, class Model, class S, class Factors>
requires requires(Factors& lu, vec<S, n_state<Model>>& b) { lu.solve(b); }
MYRIAD_FUNCTION mask_of<S> factorise_stage_matrix(const S& t, const S& per_h, const vec<S, n_state<Model>>& y,
                                                  const inputs<Model, S>& p, Factors& lu) {
    return lu.template factorise<Model>(t, per_h * S(reciprocal_gamma<Method, real_of<S>>), y, p);
}
template <class Factors, class S, extent n>
requires requires(const Factors& lu, vec<S, n>& b) { lu.solve(b); }
MYRIAD_FUNCTION void solve_factorised(const Factors& lu, vec<S, n>& b) { lu.solve(b); }

template <class Model, class S>
struct stage_factors_of {
    using type =
        std::conditional_t<factorises_sparsely<Model>, sparse_lu_factors<Model, S>, lu_factors<S, n_state<Model>>>;
};
template <class Model, class S>
using stage_factors = typename stage_factors_of<Model, S>::type;

/// 1 / h. Steps to an event may be as short as 1e-320. If 1 / (h gamma) or its reciprocal would leave the normal
/// numbers, those of a slightly longer step are used, over which nothing changes either.
template <class S>
MYRIAD_FUNCTION S reciprocal_of_step(const S& h) {
    using R = real_of<S>;
    return copysign(S(R(1)) / max(abs(h), S(R(64) / largest_of<R>)), h);
}

/// Loops over the components of a state: written out where the factors are, as one index that is no constant puts an
/// array into a GPU's local memory.
template <class Model, class S>
using component_loop = std::conditional_t<factorises_sparsely<Model> && lanes_of<S> == 1, unrolled_loop<n_state<Model>>,
                                          matrix_loop<S, n_state<Model>>>;

/// Steps from (t, y) by h to t1; `trial.k[0]`, the slope at the start, must be set. As in an explicit step, a last
/// stage that is the first of the next step is evaluated at t1.
template <class Method, class Model, class S>
MYRIAD_FUNCTION void rosenbrock_step(const S& t, const S& h, const S& t1, const vec<S, n_state<Model>>& y,
                                     const inputs<Model, S>& p, trial_step<Method, S, n_state<Model>>& trial) {
    using R = real_of<S>;
    constexpr auto n = n_state<Model>;
    using loop = component_loop<Model, S>;
    const S per_h = detail::reciprocal_of_step(h);
    stage_factors<Model, S> lu;
    trial.singular = !detail::factorise_stage_matrix<Method, Model>(t, per_h, y, p, lu);
    vec<S, n> slope_t;
    if constexpr (depends_on_time<Model>) slope_t = detail::time_derivative<Model>(t, y, p);

    vec<S, n> increment, slope = trial.k[0];
    // Writes the argument of stage `row`, or the new state, to trial.y.
    const auto advance = [&](auto row) MYRIAD_LAMBDA {
        constexpr int i = decltype(row)::value, begin = first_new_stage<Method, i>;
        loop::all([&](auto c) MYRIAD_LAMBDA {
            if constexpr (begin > 0) {
                increment[c] =
                    detail::add_stages<Method, rosenbrock_row::argument, i, begin, i>(increment[c], trial.u, c);
            } else {
                increment[c] = detail::sum_stages<Method, rosenbrock_row::argument, i, i>(trial.u, c);
            }
            trial.y[c] = y[c] + increment[c];
        });
    };
    static_for<0, Method::stages>([&](auto stage) MYRIAD_LAMBDA {
        constexpr int i = decltype(stage)::value;
        constexpr R time_weight = rosenbrock_time_weight<Method, i, R>;
        if constexpr (i > 0) {
            advance(stage);
            constexpr bool at_end = Method::first_same_as_last && i == Method::stages - 1;
            slope = detail::evaluate_rhs<Model>(at_end ? t1 : fma(S(node<Method, i, R>), h, t), trial.y, p);
            if constexpr (at_end) trial.k[1] = slope;
        }
        loop::all([&](auto c) MYRIAD_LAMBDA {
            S right = slope[c];
            if constexpr (i > 0 && !has_mass_matrix<Model>)
                right = fma(per_h, detail::sum_stages<Method, rosenbrock_row::coupling, i, i>(trial.u, c), right);
            if constexpr (depends_on_time<Model> && time_weight != R(0))
                right = fma(h * S(time_weight), slope_t[c], right);
            trial.u[stage][c] = right;
        });
        if constexpr (i > 0) {
            static_for<0, n_mass_entry<Model>>([&](auto m) MYRIAD_LAMBDA {
                constexpr int entry = decltype(m)::value, row = mass_row<Model, entry>;
                const S moved =
                    detail::sum_stages<Method, rosenbrock_row::coupling, i, i>(trial.u, mass_column<Model, entry>);
                trial.u[stage][row] = fma(per_h * S(mass_value<Model, entry, R>), moved, trial.u[stage][row]);
            });
        }
        solve_factorised(lu, trial.u[stage]);
    });
    advance(constant_index<Method::stages>{});
}

/// One component of the state at t + theta h, 0 <= theta <= 1; for a dual theta, with its derivative. `trial` has the
/// stages u and the new state y.
template <rosenbrock_method Method, class S, extent n, class Trial, class T>
MYRIAD_FUNCTION T rosenbrock_interpolation(const vec<S, n>& y, const Trial& trial, const T& theta, int component) {
    using R = real_of<S>;
    constexpr int last = dense_terms<Method> - 1;
    const T rest = S(R(1)) - theta;
    T bend = detail::sum_stages<Method, rosenbrock_row::dense, last, Method::stages>(trial.u, component);
    static_for<0, last>([&](auto r) MYRIAD_LAMBDA {
        constexpr int term = last - 1 - decltype(r)::value;
        bend = detail::add_stages<Method, rosenbrock_row::dense, term, 0, Method::stages>(theta * bend, trial.u,
                                                                                          component);
    });
    return fma(theta, fma(rest, bend, trial.y[component] - y[component]), y[component]);
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
