// SPDX-License-Identifier: MIT
// Stiff networks whose Jacobian's pattern the compiler finds: against published solutions, and against an explicit
// method with many short steps.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "myriad/myriad.hpp"
#include "problems/hires.hpp"
#include "problems/pollution.hpp"
#include "problems/van_der_pol_ring.hpp"
#include "tests/catch.hpp"
#include "tests/support/device.hpp"

namespace {

using myriad::ensemble;
using myriad::rodas_5p;

/// The largest relative difference from the published state, of the components above `least`.
template <class Model>
double error_of(const ensemble<Model>& e, std::int64_t i, const double (&published)[Model::n_state], double least) {
    double worst = 0;
    for (int c = 0; c < Model::n_state; ++c)
        if (published[c] > least) worst = std::max(worst, std::abs(e.state(c)[i] / published[c] - 1));
    return worst;
}

template <class Model>
ensemble<Model> at_start(std::int64_t size) {
    ensemble<Model> e(size);
    for (int c = 0; c < Model::n_state; ++c) e.state(c) = Model::start[c];
    e.time_domain(0, Model::t_end);
    return e;
}

}  // namespace

TEST_CASE("the pollution model ends at the published concentrations") {
    constexpr double published[] = {
        0.5646255480022769e-01, 0.1342484130422339e+00, 0.4139734331099427e-08, 0.5523140207484359e-02,
        0.2018977262302196e-06, 0.1464541863493966e-06, 0.7784249118997964e-01, 0.3245075353396018e+00,
        0.7494013383880406e-02, 0.1622293157301561e-07, 0.1135863833257075e-07, 0.2230505975721359e-02,
        0.2087162882798630e-03, 0.1396921016840158e-04, 0.8964884856898295e-02, 0.4352846369330103e-17,
        0.6899219696263405e-02, 0.1007803037365946e-03, 0.1772146513969984e-05, 0.5682943292316392e-04};
    auto e = at_start<problems::pollution>(3);
    e.parameter(problems::pollution::k1) = 0.35;
    const auto report =
        myriad::solve<rodas_5p>(tests::test_device(1), e, {.relative_tolerance = 1e-8, .absolute_tolerance = 1e-14});
    CHECK(report.failed() == 0);
    CHECK(report.notes.empty());
    CHECK(report.matrix.jacobian_entries == 82);  // of 400
    for (std::int64_t i = 0; i < 3; ++i) CHECK(error_of(e, i, published, 0) <= 1e-6);
}

TEST_CASE("the high irradiance responses end at the published concentrations") {
    constexpr double published[] = {0.7371312573325668e-3, 0.1442485726316185e-3, 0.5888729740967575e-4,
                                    0.1175651343283149e-2, 0.2386356198831331e-2, 0.6238968252742796e-2,
                                    0.2849998395185769e-2, 0.2850001604814231e-2};
    auto e = at_start<problems::hires>(2);
    const auto report =
        myriad::solve<rodas_5p>(tests::test_device(1), e, {.relative_tolerance = 1e-9, .absolute_tolerance = 1e-12});
    CHECK(report.failed() == 0);
    CHECK(report.matrix.factor_entries < 64);
    for (std::int64_t i = 0; i < 2; ++i) CHECK(error_of(e, i, published, 0) <= 1e-6);
}

TEST_CASE("a ring of 48 states is where an explicit method's short steps lead, in any ensemble to the same bit") {
    using model = problems::van_der_pol_ring<48>;
    constexpr std::int64_t size = 37;
    const auto rings = [](std::int64_t count, std::int64_t from = 0) {
        ensemble<model> e(count);
        for (std::int64_t i = 0; i < count; ++i) {
            std::mt19937 engine(static_cast<unsigned>(from + i));
            std::uniform_real_distribution<double> draws(-2, 2);
            e.parameter(model::mu)[i] = 100 + 10 * draws(engine);
            for (int c = 0; c < model::n_state; ++c) e.state(c)[i] = draws(engine);
        }
        e.time_domain(0, 0.2);
        return e;
    };
    const myriad::options stiff{.relative_tolerance = 1e-7, .absolute_tolerance = 1e-9};
    auto all = rings(size), exact = rings(size), one = rings(1, 20);
    CHECK(myriad::solve<rodas_5p>(tests::test_device(1), all, stiff).failed() == 0);
    myriad::solve<rodas_5p>(tests::test_device(1), one, stiff);
    myriad::solve<myriad::dormand_prince_8>(tests::test_device(1), exact,
                                            {.relative_tolerance = 1e-12, .absolute_tolerance = 1e-12});
    for (int c = 0; c < model::n_state; ++c) {
        for (std::int64_t i = 0; i < size; ++i) CHECK(std::abs(all.state(c)[i] - exact.state(c)[i]) <= 1e-5);
        CHECK(one.state(c)[0] == all.state(c)[20]);
    }
}
