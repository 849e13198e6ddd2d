// SPDX-License-Identifier: MIT
// Steinebach's Rodas5P, a pair of orders five and four for stiff systems, with its own interpolant of order four.
#pragma once

#include "myriad/kernel/methods/rosenbrock_tableau.hpp"

namespace myriad {

/// Steinebach, BIT Numer. Math. 63 (2023) 27: eight stages, eight evaluations per step, stiffly accurate and L-stable;
/// solution of order 5, error estimate of order 4, own interpolant of order 4. Designed to lose little order on
/// time-dependent stiff problems (Prothero and Robinson's). Coefficients: those distributed with SciML's
/// OrdinaryDiffEq, in double precision.
struct rodas_5p {
    static constexpr int stages = 8;
    static constexpr int order = 5;
    static constexpr int embedded_order = 4;
    static constexpr bool first_same_as_last = false;
    static constexpr int interpolant_order = 4;
    static constexpr int interpolant_degree = 4;

    static constexpr rosenbrock_tableau<stages, interpolant_degree - 1> tableau() {
        rosenbrock_tableau<stages, interpolant_degree - 1> t{};
        t.gamma = 0.21193756319429014;
        t.c = {0, 0.6358126895828704, 0.4095798393397535, 0.9769306725060716, 0.4288403609558664, 1, 1, 1};
        t.d = {0.21193756319429014, -0.42387512638858027, -0.3384627126235924, 1.8046452872882734, 2.325825639765069};
        t.a[1] = {3};
        t.a[2] = {2.849394379747939, 0.45842242204463923};
        t.a[3] = {-6.954028509809101, 2.489845061869568, -10.358996098473584};
        t.a[4] = {2.8029986275628964, 0.5072464736228206, -0.3988312541770524, -0.04721187230404641};
        t.a[5] = {-7.502846399306121, 2.561846144803919, -11.627539656261098, -0.18268767659942256,
                  0.030198172008377946};
        t.a[6] = t.a[7] = t.m = t.a[5];
        t.a[6][5] = t.a[7][5] = t.m[5] = 1;
        t.a[7][6] = t.m[6] = 1;
        t.m[7] = 1;
        t.coupling[1] = {-14.155112264123755};
        t.coupling[2] = {-17.97296035885952, -2.859693295451294};
        t.coupling[3] = {147.12150275711716, -1.41221402718213, 71.68940251302358};
        t.coupling[4] = {165.43517024871676, -0.4592823456491126, 42.90938336958603, -5.961986721573306};
        t.coupling[5] = {24.854864614690072, -3.0009227002832186, 47.4931110020768, 5.5814197821558125,
                         -0.6610691825249471};
        t.coupling[6] = {30.91273214028599, -3.1208243349937974, 77.79954646070892,
                         34.28646028294783, -19.097331116725623, -28.087943162872662};
        t.coupling[7] = {37.80277123390563,  -3.2571969029072276, 112.26918849496327, 66.9347231244047,
                         -40.06618937091002, -54.66780262877968,  -9.48861652309627};
        t.e[7] = 1;
        t.dense[0] = {25.948786856663858, -2.5579724845846235, 10.433815404888879, -2.3679251022685204,
                      0.524948541321073,  1.1241088310450404,  0.4272876194431874, -0.17202221070155493};
        t.dense[1] = {-9.91568850695171,  -0.9689944594115154, 3.0438037242978453, -24.495224566215796,
                      20.176138334709044, 15.98066361424651,   -6.789040303419874, -6.710236069923372};
        t.dense[2] = {11.419903575922262,  2.8879645146136994, 72.92137995996029,    80.12511834622643,
                      -52.072871366152654, -59.78993625266729, -0.15582684282751913, 4.883087185713722};
        return t;
    }
};

static_assert(satisfies_order_conditions(rodas_5p::tableau(), rodas_5p::tableau().m, 5));
static_assert(satisfies_order_conditions(rodas_5p::tableau(), embedded_weights(rodas_5p::tableau()), 4));

}  // namespace myriad
