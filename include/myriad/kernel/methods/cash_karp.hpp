// SPDX-License-Identifier: MIT
// The Cash-Karp pair of orders five and four, the method of the MPGOS paper.
#pragma once

#include "myriad/kernel/methods/tableau.hpp"

namespace myriad {

/// Cash and Karp, ACM Trans. Math. Softw. 16 (1990) 201-222: six stages, solution of order 5, error estimate of order
/// 4. Its interpolant is the cubic Hermite polynomial through both ends of the step (order 3).
struct cash_karp {
    /// Number of stages.
    static constexpr int stages = 6;
    /// Order of the solution that is advanced.
    static constexpr int order = 5;
    /// Order of the embedded solution, from which the error estimate comes; 0 for a method with fixed steps.
    static constexpr int embedded_order = 4;
    /// Whether the last stage of an accepted step is the first of the next, which saves an evaluation.
    static constexpr bool first_same_as_last = false;

    /// The coefficients, computed at compile time in double precision: the nodes, and the weights of the stages in each
    /// other, in the solution and in the error estimate. A method of your own gives its own here.
    static constexpr explicit_tableau<stages> tableau() {
        explicit_tableau<stages> t{};
        t.c = {0, 1.0 / 5, 3.0 / 10, 3.0 / 5, 1, 7.0 / 8};
        t.a[1] = {1.0 / 5};
        t.a[2] = {3.0 / 40, 9.0 / 40};
        t.a[3] = {3.0 / 10, -9.0 / 10, 6.0 / 5};
        t.a[4] = {-11.0 / 54, 5.0 / 2, -70.0 / 27, 35.0 / 27};
        t.a[5] = {1631.0 / 55296, 175.0 / 512, 575.0 / 13824, 44275.0 / 110592, 253.0 / 4096};
        t.b = {37.0 / 378, 0, 250.0 / 621, 125.0 / 594, 0, 512.0 / 1771};
        t.e = {-277.0 / 64512, 0, 6925.0 / 370944, -6925.0 / 202752, -277.0 / 14336, 277.0 / 7084};
        return t;
    }
};

static_assert(satisfies_order_conditions(cash_karp::tableau(), cash_karp::tableau().b, 5));
static_assert(satisfies_order_conditions(cash_karp::tableau(), embedded_weights(cash_karp::tableau()), 4));

}  // namespace myriad
