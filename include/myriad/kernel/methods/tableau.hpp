// SPDX-License-Identifier: MIT
// The coefficients of an explicit Runge-Kutta method in Butcher's form, and the checks that every method must pass.
// Evaluated at compile time only.
#pragma once

#include <array>
#include <cstddef>

namespace myriad {

/// Butcher tableau of `stages` stages: nodes c, matrix a (strictly lower), weights b of the solution, error weights e =
/// b - b_hat (zero for a method without error estimate).
template <int stages>
struct explicit_tableau {
    /// One coefficient per stage.
    using row = std::array<double, static_cast<std::size_t>(stages)>;

    row c{};                                                ///< nodes, as fractions of the step
    std::array<row, static_cast<std::size_t>(stages)> a{};  ///< a[i][j]: weight of stage j in the argument of stage i
    row b{};                                                ///< weights of the solution
    row e{};  ///< weights of the error estimate: b minus the weights of the embedded solution

    /// Weight of stage j in the argument of stage `of` (1 <= of < stages), in the solution (of == stages) or in the
    /// error estimate (of == stages + 1).
    constexpr double weight(int of, int j) const {
        const auto unsigned_j = static_cast<std::size_t>(j);
        if (of == stages) return b[unsigned_j];
        if (of == stages + 1) return e[unsigned_j];
        return a[static_cast<std::size_t>(of)][unsigned_j];
    }
};

/// Order conditions of the given weights up to order five (Hairer, Norsett, Wanner, Solving ODE I, Table II.2.1, 17
/// trees), each within `tolerance`, the row-sum condition, and four of each higher order. The full set is in the tests.
template <int stages>
constexpr bool satisfies_order_conditions(const explicit_tableau<stages>& t,
                                          const typename explicit_tableau<stages>::row& w, int order,
                                          double tolerance = 2e-14) {
    constexpr auto n = static_cast<std::size_t>(stages);
    using column = typename explicit_tableau<stages>::row;
    const column ones = [] {
        column v{};
        for (auto& x : v) x = 1;
        return v;
    }();
    const auto times = [](const column& x, const column& y) {
        column z{};
        for (std::size_t i = 0; i < n; ++i) z[i] = x[i] * y[i];
        return z;
    };
    const auto apply = [&t](const column& x) {
        column z{};
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < i; ++j) z[i] += t.a[i][j] * x[j];
        return z;
    };
    bool satisfied = true;
    const auto check = [&](const column& x, double value) {
        double sum = 0, size = 0;
        for (std::size_t i = 0; i < n; ++i) {
            sum += w[i] * x[i];
            size += w[i] * x[i] < 0 ? -w[i] * x[i] : w[i] * x[i];
        }
        const double residual = sum < value ? value - sum : sum - value;
        satisfied = satisfied && residual <= tolerance * (1 + size);
    };
    const column c = t.c, c2 = times(c, c), c3 = times(c2, c), ac = apply(c);
    const column row_sums = apply(ones);
    for (std::size_t i = 0; i < n; ++i) {
        const double residual = row_sums[i] < c[i] ? c[i] - row_sums[i] : row_sums[i] - c[i];
        satisfied = satisfied && residual <= 10 * tolerance;
    }
    check(ones, 1.0);
    if (order >= 2) check(c, 1.0 / 2);
    if (order >= 3) check(c2, 1.0 / 3), check(ac, 1.0 / 6);
    if (order >= 4) {
        check(c3, 1.0 / 4), check(times(c, ac), 1.0 / 8);
        check(apply(c2), 1.0 / 12), check(apply(ac), 1.0 / 24);
    }
    if (order >= 5) {
        check(times(c3, c), 1.0 / 5), check(times(c2, ac), 1.0 / 10), check(times(ac, ac), 1.0 / 20);
        check(times(c, apply(c2)), 1.0 / 15), check(times(c, apply(ac)), 1.0 / 30);
        check(apply(c3), 1.0 / 20), check(apply(times(c, ac)), 1.0 / 40);
        check(apply(apply(c2)), 1.0 / 60), check(apply(apply(ac)), 1.0 / 120);
    }
    // for each higher order, the conditions of the bushy tree, its neighbours and the tall tree
    column power = c3, chain = apply(apply(ac));
    double factorial = 120;
    for (int q = 6; q <= order; ++q) {
        check(times(power, ac), 1.0 / (2 * q));
        power = times(power, c);
        check(apply(power), 1.0 / (q * (q - 1)));
        check(times(power, c), 1.0 / q);
        chain = apply(chain);
        factorial *= q;
        check(chain, 1 / factorial);
    }
    return satisfied;
}

/// Weights of the embedded solution, b_hat = b - e.
template <int stages>
constexpr typename explicit_tableau<stages>::row embedded_weights(const explicit_tableau<stages>& t) {
    typename explicit_tableau<stages>::row w{};
    for (std::size_t i = 0; i < w.size(); ++i) w[i] = t.b[i] - t.e[i];
    return w;
}

}  // namespace myriad
