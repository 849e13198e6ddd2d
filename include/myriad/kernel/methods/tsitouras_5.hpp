// SPDX-License-Identifier: MIT
// Tsitouras' pair of orders five and four, with its own interpolant of order four.
#pragma once

#include "myriad/kernel/methods/tableau.hpp"

namespace myriad {

/// Tsitouras, Comput. Math. Appl. 62 (2011) 770-775: seven stages, the last of which is the first of the next step, so
/// six evaluations per step; solution of order 5, error estimate of order 4, own interpolant of order 4 (published in
/// double precision). Coefficients: the 80-digit values distributed with SciML's OrdinaryDiffEq, rounded to double.
struct tsitouras_5 {
    static constexpr int stages = 7;
    static constexpr int order = 5;
    static constexpr int embedded_order = 4;
    static constexpr bool first_same_as_last = true;

    static constexpr explicit_tableau<stages> tableau() {
        explicit_tableau<stages> t{};
        // clang-format off
        t.c = {0, 161.0 / 1000, 327.0 / 1000, 9.0 / 10, 0.9800255409045097, 1, 1};
        t.a[1] = {161.0 / 1000};
        t.a[2] = {-0.008480655492356989, 0.335480655492357};
        t.a[3] = {2.8971530571054935, -6.359448489975075, 4.3622954328695815};
        t.a[4] = {5.325864828439257, -11.748883564062828, 7.4955393428898365, -0.09249506636175525};
        t.a[5] = {5.86145544294642, -12.92096931784711, 8.159367898576159, -0.071584973281401, -0.028269050394068383};
        t.a[6] = {0.09646076681806523, 1.0 / 100, 0.4798896504144996, 1.379008574103742, -3.290069515436081,
                  2.324710524099774};
        t.b = {0.09646076681806523, 1.0 / 100, 0.4798896504144996, 1.379008574103742, -3.290069515436081,
               2.324710524099774, 0};
        t.e = {-0.0017800110522257714, -0.0008164344596567469, 0.007880878010261995, -0.1447110071732629,
               0.5823571654525552, -0.45808210592918697, 1.0 / 66};
        // clang-format on
        return t;
    }

    /// Order of the method's own interpolant; a method without this member gets the cubic Hermite polynomial.
    static constexpr int interpolant_order = 4;
    /// Degree of that polynomial in theta, the fraction of the step.
    static constexpr int interpolant_degree = 4;
    /// Coefficient of theta^(power + 1) in the weight of a stage: y(t + theta h) = y + h sum_i b_i(theta) k_i.
    static constexpr double interpolant_weight(int stage, int power) {
        constexpr double weights[stages][interpolant_degree] = {
            {1.0, -2.763706197274826, 2.9132554618219126, -1.0530884977290216},
            {0.0, 0.13169999999999998, -0.2234, 0.1017},
            {0.0, 3.9302962368947516, -5.941033872131505, 2.490627285651253},
            {0.0, -12.411077166933676, 30.33818863028232, -16.548102889244902},
            {0.0, 37.50931341651104, -88.1789048947664, 47.37952196281928},
            {0.0, -27.896526289197286, 65.09189467479366, -34.87065786149661},
            {0.0, 1.5, -4.0, 2.5},
        };
        return weights[stage][power];
    }
};

static_assert(satisfies_order_conditions(tsitouras_5::tableau(), tsitouras_5::tableau().b, 5));
static_assert(satisfies_order_conditions(tsitouras_5::tableau(), embedded_weights(tsitouras_5::tableau()), 4));

}  // namespace myriad
