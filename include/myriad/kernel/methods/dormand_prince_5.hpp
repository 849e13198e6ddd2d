// SPDX-License-Identifier: MIT
// Dormand and Prince's pair of orders five and four, with an interpolant of order four.
#pragma once

#include "myriad/kernel/methods/tableau.hpp"

namespace myriad {

/// Dormand and Prince, J. Comput. Appl. Math. 6 (1980) 19-26: seven stages, the last of which is the first of the next
/// step, so six evaluations per step; the solution has order 5, the error estimate order 4. Interpolant of order 4:
/// Shampine, Math. Comp. 46 (1986) 135-150, as in DOPRI5 (Hairer, Norsett, Wanner, Solving ODE I, II.6).
struct dormand_prince_5 {
    static constexpr int stages = 7;
    static constexpr int order = 5;
    static constexpr int embedded_order = 4;
    static constexpr bool first_same_as_last = true;

    static constexpr explicit_tableau<stages> tableau() {
        explicit_tableau<stages> t{};
        t.c = {0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1};
        t.a[1] = {1.0 / 5};
        t.a[2] = {3.0 / 40, 9.0 / 40};
        t.a[3] = {44.0 / 45, -56.0 / 15, 32.0 / 9};
        t.a[4] = {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729};
        t.a[5] = {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656};
        t.a[6] = {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84};
        t.b = {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84, 0};
        t.e = {71.0 / 57600, 0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
        return t;
    }

    static constexpr int interpolant_order = 4;
    static constexpr int interpolant_degree = 4;
    /// Coefficient of theta^(power + 1) in the weight of a stage: y(t + theta h) = y + h sum_i b_i(theta) k_i.
    static constexpr double interpolant_weight(int stage, int power) {
        constexpr double weights[stages][interpolant_degree] = {
            {1, -2.8535800653862835, 3.0717434641059005, -1.1270175653862835},
            {0, 0, 0, 0},
            {0, 4.023133379230305, -6.249321565289, 2.675424484351598},
            {0, -3.7324019615885042, 10.068970589843675, -5.685526961588504},
            {0, 2.5548038301849423, -6.399112377351017, 3.5219323679207912},
            {0, -1.3744241142186024, 3.272657752246729, -1.7672812570757455},
            {0, 1.3824689317781436, -3.764937863556287, 2.382468931778144},
        };
        return weights[stage][power];
    }
};

static_assert(satisfies_order_conditions(dormand_prince_5::tableau(), dormand_prince_5::tableau().b, 5));
static_assert(satisfies_order_conditions(dormand_prince_5::tableau(), embedded_weights(dormand_prince_5::tableau()),
                                         4));

}  // namespace myriad
