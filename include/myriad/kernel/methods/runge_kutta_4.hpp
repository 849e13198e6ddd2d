// SPDX-License-Identifier: MIT
// The classical Runge-Kutta method of order four, with fixed steps.
#pragma once

#include "myriad/kernel/methods/tableau.hpp"

namespace myriad {

/// Kutta's classical method of order 4: four stages, fixed step. Source: Kutta, Z. Math. Phys. 46 (1901) 435-453.
/// Its interpolant is the cubic Hermite polynomial through both ends of the step (order 3).
struct runge_kutta_4 {
    static constexpr int stages = 4;
    static constexpr int order = 4;
    static constexpr int embedded_order = 0;  // no error estimate: fixed steps only
    static constexpr bool first_same_as_last = false;

    static constexpr explicit_tableau<stages> tableau() {
        explicit_tableau<stages> t{};
        t.c = {0, 1.0 / 2, 1.0 / 2, 1};
        t.a[1] = {1.0 / 2};
        t.a[2] = {0, 1.0 / 2};
        t.a[3] = {0, 0, 1};
        t.b = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
        return t;
    }
};

static_assert(satisfies_order_conditions(runge_kutta_4::tableau(), runge_kutta_4::tableau().b, 4));

}  // namespace myriad
