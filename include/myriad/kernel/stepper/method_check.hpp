// SPDX-License-Identifier: MIT
// Checks a method's claims against its coefficients wherever it is compiled for a model: a wrong claim would go
// unnoticed and cost accuracy. Evaluated only at compile time.
#pragma once

#include <cstddef>

#include "myriad/kernel/methods/adaptive.hpp"
#include "myriad/kernel/methods/rosenbrock_tableau.hpp"
#include "myriad/kernel/methods/tableau.hpp"
#include "myriad/kernel/stepper/dense_output.hpp"
#include "myriad/kernel/stepper/explicit_rk.hpp"
#include "myriad/kernel/stepper/rosenbrock.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Coefficients of thirteen digits pass; a wrong claim leaves a far larger residual.
inline constexpr double rounding_of_coefficients = 1e-12;

constexpr bool nearly_equal(double a, double b) {
    const double scale = 1 + (a < 0 ? -a : a), difference = a < b ? b - a : a - b;
    return difference <= rounding_of_coefficients * scale;
}
template <class Row>
constexpr bool nearly_equal(const Row& a, const Row& b) {
    bool equal = true;
    for (std::size_t i = 0; i < a.size(); ++i) equal = equal && nearly_equal(a[i], b[i]);
    return equal;
}
template <class Row>
constexpr bool all_zero(const Row& weights) {
    bool zero = true;
    for (const double w : weights) zero = zero && w == 0;
    return zero;
}

/// The weights of the solution.
template <class Tableau>
constexpr auto solution_weights(const Tableau& t) {
    if constexpr (requires { t.coupling; }) {
        return t.m;
    } else {
        return t.b;
    }
}

template <class Tableau, class Row>
constexpr bool has_order(const Tableau& t, const Row& weights, int order) {
    return satisfies_order_conditions(t, weights, order, rounding_of_coefficients);
}

/// Whether every stage's argument has weights, and only for earlier stages.
template <class Tableau>
constexpr bool stages_are_explicit(const Tableau& t) {
    bool fine = true;
    for (std::size_t i = 0; i < t.a.size(); ++i) {
        bool any = i == 0;
        for (std::size_t j = 0; j < t.a.size(); ++j) {
            if (j < i)
                any = any || t.a[i][j] != 0;
            else
                fine = fine && t.a[i][j] == 0;
        }
        fine = fine && any;
    }
    return fine;
}

/// Whether the last stage is the slope at the new state and time.
template <class Tableau>
constexpr bool last_stage_is_next_first(const Tableau& t) {
    return nearly_equal(t.a.back(), solution_weights(t)) && solution_weights(t).back() == 0 &&
           nearly_equal(t.c.back(), 1.0);
}

/// The tableau of an explicit method including the additional stages of its interpolant.
template <class Method>
constexpr auto tableau_of_interpolant() {
    constexpr auto step = Method::tableau();
    constexpr std::size_t stages = Method::stages;
    explicit_tableau<interpolant_stages<Method>> t{};
    for (std::size_t i = 0; i < stages; ++i) {
        t.c[i] = step.c[i];
        for (std::size_t j = 0; j < stages; ++j) t.a[i][j] = step.a[i][j];
        t.b[i] = step.b[i];
    }
    if constexpr (extra_stages<Method> != 0) {
        t.c[stages] = 1;
        for (std::size_t j = 0; j < stages; ++j) t.a[stages][j] = step.b[j];
        for (int i = 0; i < extra_stages<Method>; ++i) {
            const auto row = stages + 1 + static_cast<std::size_t>(i);
            t.c[row] = Method::extra_node(i);
            for (std::size_t j = 0; j < row; ++j) t.a[row][j] = Method::extra_weight(i, static_cast<int>(j));
        }
    }
    return t;
}

/// Weights of the stages in y(t + theta h) - y.
template <class Method>
constexpr auto interpolant_weights_at(double theta) {
    if constexpr (rosenbrock_method<Method>) {
        constexpr auto t = Method::tableau();
        auto w = t.m;
        for (std::size_t i = 0; i < w.size(); ++i) {
            double bend = 0;
            for (std::size_t r = t.dense.size(); r-- > 0;) bend = theta * bend + t.dense[r][i];
            w[i] = theta * (w[i] + (1 - theta) * bend);
        }
        return w;
    } else {
        typename explicit_tableau<interpolant_stages<Method>>::row w{};
        for (std::size_t i = 0; i < w.size(); ++i)
            for (int power = Method::interpolant_degree; power-- > 0;)
                w[i] = theta * (w[i] + Method::interpolant_weight(static_cast<int>(i), power));
        return w;
    }
}

/// Whether the interpolant has the stated order at t + theta h, where it is the solution of a method with step theta h.
template <class Method>
constexpr bool interpolant_has_order(double theta) {
    auto w = interpolant_weights_at<Method>(theta);
    if constexpr (rosenbrock_method<Method>) {
        auto t = Method::tableau();
        t.gamma /= theta;
        for (std::size_t i = 0; i < t.c.size(); ++i) {
            t.c[i] /= theta;
            t.d[i] /= theta;
            for (double& x : t.coupling[i]) x *= theta;
        }
        return has_order(t, w, Method::interpolant_order);
    } else {
        auto t = tableau_of_interpolant<Method>();
        for (std::size_t i = 0; i < w.size(); ++i) {
            w[i] /= theta;
            t.c[i] /= theta;
            for (double& x : t.a[i]) x /= theta;
        }
        return has_order(t, w, Method::interpolant_order);
    }
}

template <class Method>
constexpr bool check_error_estimate() {
    constexpr auto t = Method::tableau();
    static_assert(!all_zero(t.e),
                  "the method has an embedded_order, but its error weights e are all zero: give e = b - b_hat, or "
                  "embedded_order = 0 for fixed steps");
    static_assert(has_order(t, embedded_weights(t), Method::embedded_order),
                  "the embedded solution, of weights b - e, has not the order that embedded_order claims: steps would "
                  "be chosen by "
                  "a wrong power of the error; correct e or embedded_order");
    if constexpr (requires { Method::estimate_order; })
        static_assert(Method::estimate_order >= Method::embedded_order && Method::estimate_order <= Method::order,
                      "estimate_order is not between embedded_order and order");
    if constexpr (has_coarse_estimate<Method>) {
        constexpr bool consistent = [] {
            double sum = 0, size = 0;
            for (int i = 0; i < Method::stages; ++i) {
                const double w = Method::coarse_error_weight(i);
                sum += w;
                size += w < 0 ? -w : w;
            }
            return size > 0 && (sum < 0 ? -sum : sum) <= rounding_of_coefficients * (1 + size);
        }();
        static_assert(consistent,
                      "the weights of coarse_error_weight are no error estimate: their sum is not zero, or all are");
    }
    return true;
}

template <class Method>
constexpr bool check_interpolant() {
    if constexpr (!rosenbrock_method<Method>) {
        static_assert(
            requires { Method::interpolant_weight(0, 0); },
            "the method has an interpolant_degree: give it `static constexpr double interpolant_weight(int stage, int "
            "power)`");
        static_assert(nearly_equal(interpolant_weights_at<Method>(1), tableau_of_interpolant<Method>().b),
                      "the interpolant does not end at the step's new state: the weights of each stage, "
                      "interpolant_weight(stage, "
                      "power), must add up to its weight b, those of other stages to zero");
    } else {
        static_assert(Method::interpolant_degree == dense_terms<Method> + 1,
                      "interpolant_degree is not the number of the tableau's rows `dense` and one");
    }
    if constexpr (requires { Method::interpolant_order; })
        static_assert(
            interpolant_has_order<Method>(0.375) && interpolant_has_order<Method>(0.75),
            "the interpolant has not the order that interpolant_order claims: samples and events would be less "
            "accurate "
            "than its steps; correct interpolant_weight (or the rows `dense`), its extra stages, or interpolant_order");
    return true;
}

/// Refuses a method whose coefficients do not satisfy its claims. For orders above five only some of the conditions are
/// checked.
template <class Method>
constexpr bool check_method() requires(!stochastic_method<Method>) {
    constexpr bool complete = requires {
        Method::stages;
        Method::order;
        Method::embedded_order;
        Method::first_same_as_last;
        Method::tableau().c;
    };
    static_assert(complete,
                  "a method is a struct with `static constexpr` members stages, order, embedded_order and "
                  "first_same_as_last, and "
                  "a `static constexpr` function tableau: see examples/own_method");
    if constexpr (complete) {
        constexpr auto t = Method::tableau();
        static_assert(t.c.size() == static_cast<std::size_t>(Method::stages),
                      "the tableau has not as many stages as the method says");
        if constexpr (t.c.size() == static_cast<std::size_t>(Method::stages)) {
            static_assert(stages_are_explicit(t),
                          "the tableau's matrix a must be lower triangular without its diagonal, as stages are "
                          "computed one after the "
                          "other, and every row but the first must have a weight");
            static_assert(
                Method::order >= 1 && has_order(t, solution_weights(t), Method::order),
                "the method's coefficients do not satisfy the conditions of the order that it claims, or its nodes c "
                "are "
                "not the row sums of a: correct the tableau, of which thirteen digits are needed, or `order`");
            static_assert(!Method::first_same_as_last || last_stage_is_next_first(t),
                          "the method claims first_same_as_last, but its last stage is not the slope at the new state: "
                          "the last row of "
                          "a must be the solution's weights, of which the last is zero, and the last node must be 1; "
                          "else say false");
            static_assert(Method::embedded_order >= 0 && Method::embedded_order <= Method::order,
                          "embedded_order must be from 1 to order, or 0 for a method with fixed steps");
            if constexpr (Method::embedded_order > 0) static_assert(check_error_estimate<Method>());
            if constexpr (has_own_interpolant<Method>) static_assert(check_interpolant<Method>());
        }
    }
    return true;
}

/// Methods for stochastic equations have no tableau whose order could be checked.
template <class Method>
constexpr bool check_method() requires stochastic_method<Method> {
    constexpr bool complete = requires {
        Method::stages;
        Method::first_same_as_last;
        requires(Method::embedded_order == 0 || estimates_error<Method>) && !Method::first_same_as_last;
    };
    static_assert(complete,
                  "a method for stochastic equations is a struct with `static constexpr` members stages, "
                  "embedded_order (0), first_same_as_last (false), strong_order, weak_order and noise, and a function "
                  "step");
    return true;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
