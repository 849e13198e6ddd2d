// SPDX-License-Identifier: MIT
// Shampine and Reichelt's pair of orders two and three for stiff systems and crude tolerances, the method of ode23s.
#pragma once

#include "myriad/kernel/methods/rosenbrock_tableau.hpp"

namespace myriad {

/// Shampine and Reichelt, SIAM J. Sci. Comput. 18 (1997) 1-22: three stages, the last of which is the first of the next
/// step, so two evaluations per step; the solution is L-stable and of order 2. The error estimate is its distance from
/// a solution of order 3. Own interpolant of order 2, which uses no slope, so that stiffness does not spoil it.
/// Coefficients: the published ones with d = 1 / (2 + sqrt 2), e32 = 6 + sqrt 2, transformed in exact arithmetic.
struct rosenbrock_23 {
    static constexpr int stages = 3;
    static constexpr int order = 2;
    static constexpr int embedded_order = 2;  // the order of the estimate, which decreases as h^3
    static constexpr bool first_same_as_last = true;
    static constexpr int interpolant_order = 2;
    static constexpr int interpolant_degree = 2;

    static constexpr rosenbrock_tableau<stages, interpolant_degree - 1> tableau() {
        constexpr double root_2 = 1.4142135623730951, d = 0.2928932188134525;
        rosenbrock_tableau<stages, interpolant_degree - 1> t{};
        t.gamma = d;
        t.c = {0, 1.0 / 2, 1};
        t.d = {d, 0, -d};
        t.a[1] = {1 + root_2 / 2};
        t.a[2] = {2 + root_2, 2 + root_2};
        t.coupling[1] = {-(2 + root_2)};
        t.coupling[2] = {-2 * (2 + root_2), -(14 + 8 * root_2)};
        t.m = {2 + root_2, 2 + root_2, 0};
        t.e = {-(2 + root_2) / 6, -(5 + 3 * root_2) / 3, -(2 + root_2) / 6};
        t.dense[0] = {0, -(4 + 3 * root_2), 0};
        return t;
    }
};

static_assert(satisfies_order_conditions(rosenbrock_23::tableau(), rosenbrock_23::tableau().m, 2));
static_assert(satisfies_order_conditions(rosenbrock_23::tableau(), embedded_weights(rosenbrock_23::tableau()), 3));

}  // namespace myriad
