// SPDX-License-Identifier: MIT
// The coefficients of a Rosenbrock method in the form that avoids products with the Jacobian, and the order conditions
// that every method must satisfy. Evaluated at compile time only.
#pragma once

#include <array>
#include <cstddef>

namespace myriad::detail {

/// A method whose coefficients are a rosenbrock_tableau.
template <class Method>
concept rosenbrock_method = requires {
    Method::tableau().coupling;
};

}  // namespace myriad::detail

namespace myriad {

/// With u_i = h sum_j gamma_ij k_j the stages are
///     (I / (h gamma) - J) u_i = f(t + c_i h, y + sum_j a_ij u_j) + sum_j (coupling_ij / h) u_j + h d_i df/dt
/// and the solution is y + sum_i m_i u_i, its error estimate sum_i e_i u_i (Hairer, Wanner, Solving ODE II, IV.7, eq.
/// (7.25)). Inside the step, at t + theta h,
///     y(theta) = (1 - theta) y + theta (y1 + (1 - theta) (v_0 + theta (v_1 + ...))),  v_r = sum_i dense_ri u_i.
template <int stages, int dense_terms>
struct rosenbrock_tableau {
    /// One coefficient per stage.
    using row = std::array<double, static_cast<std::size_t>(stages)>;
    /// One coefficient per pair of stages.
    using square = std::array<row, static_cast<std::size_t>(stages)>;

    double gamma{};     ///< the diagonal element
    row c{};            ///< nodes, as fractions of the step
    row d{};            ///< factors of df/dt
    square a{};         ///< weights in the arguments of the stages
    square coupling{};  ///< factors of earlier stages on the right-hand side
    row m{};            ///< weights of the solution
    row e{};            ///< weights of the error estimate
    /// Weights v_r of the interpolant.
    std::array<row, static_cast<std::size_t>(dense_terms)> dense{};

    /// Weight of stage j in the argument of stage `of`, or in the solution (of == stages).
    constexpr double weight(int of, int j) const {
        return of == stages ? m[static_cast<std::size_t>(j)]
                            : a[static_cast<std::size_t>(of)][static_cast<std::size_t>(j)];
    }
};

/// Order conditions up to order five of the weights `m` of the stages u, each within `tolerance` relative to the sum of
/// the magnitudes of its terms; and that c and d are the row sums of alpha and gamma. In Butcher's form, k_i = f(y + h
/// sum alpha_ij k_j) + h J sum gamma_ij k_j and beta = alpha + gamma; a vertex of a tree with one child counts beta,
/// one with several children alpha for each (Hairer, Wanner, IV.7, eq. (7.11') and Table 7.1).
template <int stages, int dense_terms>
constexpr bool satisfies_order_conditions(const rosenbrock_tableau<stages, dense_terms>& t,
                                          const typename rosenbrock_tableau<stages, dense_terms>::row& m, int order,
                                          double tolerance = 2e-14) {
    constexpr auto n = static_cast<std::size_t>(stages);
    using column = typename rosenbrock_tableau<stages, dense_terms>::row;
    using square = typename rosenbrock_tableau<stages, dense_terms>::square;
    const auto size_of = [](double x) { return x < 0 ? -x : x; };
    // gamma = (I / gamma - coupling)^-1, row by row
    square gamma{}, alpha{}, beta{};
    column b{};
    for (std::size_t i = 0; i < n; ++i) {
        gamma[i][i] = t.gamma;
        for (std::size_t j = 0; j < i; ++j)
            for (std::size_t k = j; k < i; ++k) gamma[i][j] += t.gamma * t.coupling[i][k] * gamma[k][j];
        for (std::size_t j = 0; j <= i; ++j) {
            for (std::size_t k = j; k < i; ++k) alpha[i][j] += t.a[i][k] * gamma[k][j];
            beta[i][j] = alpha[i][j] + gamma[i][j];
            b[j] += m[i] * gamma[i][j];
        }
    }
    const auto apply = [](const square& s, const column& x) {
        column z{};
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j) z[i] += s[i][j] * x[j];
        return z;
    };
    const auto times = [](const column& x, const column& y) {
        column z{};
        for (std::size_t i = 0; i < n; ++i) z[i] = x[i] * y[i];
        return z;
    };
    bool satisfied = true;
    const auto check = [&](const column& x, double value) {
        double sum = -value, size = 1;
        for (std::size_t i = 0; i < n; ++i) {
            sum += b[i] * x[i];
            size += size_of(b[i] * x[i]);
        }
        satisfied = satisfied && size_of(sum) <= tolerance * size;
    };
    column ones{};
    for (auto& x : ones) x = 1;
    const auto A = [&](const column& x) { return apply(alpha, x); };
    const auto B = [&](const column& x) { return apply(beta, x); };
    const column a1 = A(ones), b1 = B(ones), a1_a1 = times(a1, a1), b1_b = B(b1);
    const column row_sums = apply(gamma, ones);
    for (std::size_t i = 0; i < n; ++i)
        satisfied =
            satisfied && size_of(a1[i] - t.c[i]) <= 100 * tolerance && size_of(row_sums[i] - t.d[i]) <= 100 * tolerance;
    check(ones, 1.0);
    if (order >= 2) check(b1, 1.0 / 2);
    if (order >= 3) check(a1_a1, 1.0 / 3), check(b1_b, 1.0 / 6);
    if (order >= 4) {
        check(times(a1_a1, a1), 1.0 / 4), check(times(a1, A(b1)), 1.0 / 8);
        check(B(a1_a1), 1.0 / 12), check(B(b1_b), 1.0 / 24);
    }
    if (order >= 5) {
        check(times(a1_a1, a1_a1), 1.0 / 5), check(times(a1_a1, A(b1)), 1.0 / 10), check(times(A(b1), A(b1)), 1.0 / 20);
        check(times(a1, A(a1_a1)), 1.0 / 15), check(times(a1, A(b1_b)), 1.0 / 30);
        check(B(times(a1_a1, a1)), 1.0 / 20), check(B(times(a1, A(b1))), 1.0 / 40);
        check(B(B(a1_a1)), 1.0 / 60), check(B(B(b1_b)), 1.0 / 120);
    }
    return satisfied;
}

/// Weights of the embedded solution, m - e.
template <int stages, int dense_terms>
constexpr auto embedded_weights(const rosenbrock_tableau<stages, dense_terms>& t) {
    auto w = t.m;
    for (std::size_t i = 0; i < w.size(); ++i) w[i] -= t.e[i];
    return w;
}

}  // namespace myriad
