// SPDX-License-Identifier: MIT
// A method that is not in the library, given by its tableau.
#pragma once

#include <myriad/tableau.hpp>

// snippet: method
/// Bogacki and Shampine's pair of orders three and two, Appl. Math. Lett. 2 (1989) 321: four stages, the last of which
/// is the first of the next step. Without an interpolant of its own it uses the cubic Hermite polynomial, which has the
/// same order.
struct bogacki_shampine_3 {
    static constexpr int stages = 4;
    static constexpr int order = 3;
    static constexpr int embedded_order = 2;
    static constexpr bool first_same_as_last = true;

    static constexpr myriad::explicit_tableau<stages> tableau() {
        myriad::explicit_tableau<stages> t{};
        t.c = {0, 1.0 / 2, 3.0 / 4, 1};
        t.a[1] = {1.0 / 2};
        t.a[2] = {0, 3.0 / 4};
        t.a[3] = {2.0 / 9, 1.0 / 3, 4.0 / 9};
        t.b = {2.0 / 9, 1.0 / 3, 4.0 / 9, 0};
        t.e = {-5.0 / 72, 1.0 / 12, 1.0 / 9, -1.0 / 8};  // b minus the weights of order two
        return t;
    }
};
// end of snippet
