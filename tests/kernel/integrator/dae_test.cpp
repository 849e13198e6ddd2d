// SPDX-License-Identifier: MIT
// Equations M y' = f with a singular mass matrix: against other forms of the same problem, published values and exact
// solutions; initial values that do not satisfy them.
#include "tests/support/dae.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

#include "myriad/kernel/model/null_spaces.hpp"
#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/host/ensemble/refusal.hpp"
#include "tests/support/device.hpp"
#include "tests/support/stiff.hpp"

namespace {

using myriad::ensemble;
using myriad::rodas_5p;

ensemble<dae::transistor_amplifier> amplifiers(std::int64_t size) {
    ensemble<dae::transistor_amplifier> e(size);
    const double start[] = {0, 3, 3, 6, 3, 3, 6, 0};
    for (int c = 0; c < 8; ++c) e.state(c) = start[c];
    e.time_domain(0, 0.2);
    return e;
}

template <class R>
ensemble<dae::robertson, R> reactions(std::int64_t size) {
    ensemble<dae::robertson, R> e(size);
    e.state(dae::robertson::a) = R(1);
    e.state(dae::robertson::b) = R(0);
    e.state(dae::robertson::c) = R(0);
    e.time_domain(R(0), R(40));
    return e;
}

/// sin t and its square, by the algebraic equations, and the states that follow.
template <class Model>
void check_sines(int expected_factors) {
    constexpr int n = Model::n_state;
    ensemble<Model> e(3);
    for (int c = 0; c < n; ++c) e.state(c) = 0.0;
    e.time_domain(0, 3);
    const auto report =
        myriad::solve<rodas_5p>(tests::test_device(1), e, {.relative_tolerance = 1e-9, .absolute_tolerance = 1e-9});
    CHECK(report.matrix.factor_entries == expected_factors);
    for (std::int64_t i = 0; i < 3; ++i) {
        CHECK(e.status(i) == myriad::status::success);
        // a hundred steps of errors of 1e-9 at most
        for (int c = 0; c <= n - 2; ++c) CHECK(std::abs(e.state(c)[i] - std::sin(3.0)) <= 1e-7);
        CHECK(std::abs(e.state(n - 1)[i] - std::sin(3.0) * std::sin(3.0)) <= 1e-7);
    }
}

}  // namespace

TEST_CASE("Robertson's reactions with the sum of the concentrations as an equation are those with three slopes") {
    auto e = reactions<double>(5);
    ensemble<stiff::robertson> slopes(1);
    slopes.state(0) = 1.0;
    slopes.state(1) = slopes.state(2) = 0.0;
    slopes.time_domain(0, 40);
    const myriad::options o{.relative_tolerance = 1e-8, .absolute_tolerance = {1e-10, 1e-14, 1e-10}};
    const auto report = myriad::solve<rodas_5p>(tests::test_device(1), e, o);
    myriad::solve<rodas_5p>(tests::test_device(1), slopes, o);
    CHECK(report.failed() == 0);
    for (std::int64_t i = 0; i < 5; ++i) {
        for (int c = 0; c < 3; ++c) CHECK(std::abs(e.state(c)[i] / slopes.state(c)[0] - 1) <= 1e-6);
        CHECK(std::abs(e.state(0)[i] + e.state(1)[i] + e.state(2)[i] - 1) <= 1e-14);
    }
    auto single = reactions<float>(3);
    CHECK(myriad::solve<rodas_5p>(tests::test_device(1), single,
                                  {.relative_tolerance = 1e-4, .absolute_tolerance = {1e-6, 1e-9, 1e-6}})
              .failed() == 0);
    CHECK(std::abs(static_cast<double>(single.state(0)[1]) / slopes.state(0)[0] - 1) <= 1e-3);
}

TEST_CASE("the transistor amplifier ends at the published voltages, through a mass matrix with coupled rows") {
    auto e = amplifiers(2);
    const auto report =
        myriad::solve<rodas_5p>(tests::test_device(1), e, {.relative_tolerance = 1e-7, .absolute_tolerance = 1e-7});
    CHECK(report.failed() == 0);
    CHECK(report.matrix.jacobian_entries == 16);
    CHECK(report.matrix.factor_entries < 64);
    const double published[] = {-0.5562145012262709e-2, 0.3006522471903042e1, 0.2849958788608128e1,
                                0.2926422536206241e1,   0.2704617865010554e1, 0.2761837778393145e1,
                                0.4770927631616772e1,   0.1236995868091548e1};
    for (std::int64_t i = 0; i < 2; ++i)
        for (int c = 0; c < 8; ++c) CHECK(std::abs(e.state(c)[i] - published[c]) <= 2e-6);
}

TEST_CASE("algebraic equations need not contain the states of their rows, and may be scaled") {
    check_sines<dae::crossed<9>>(81);  // no pivots on the diagonal: dense, with row exchanges
    check_sines<dae::straight<9>>(9 + 7 + 1);
}

TEST_CASE("samples of algebraic states satisfy their equations to the order of the interpolant") {
    using model = dae::crossed<4>;
    ensemble<model> e(2);
    for (int c = 0; c < 4; ++c) e.state(c) = 0.0;
    e.time_domain(0, 3);
    const auto report = myriad::solve<myriad::dense<rodas_5p>>(
        tests::test_device(1), e,
        {.relative_tolerance = 1e-9,
         .absolute_tolerance = 1e-9,
         .maximum_step = 0.05,
         .samples = {.states = {model::z, model::w}, .capacity = 31, .evenly = 31}});
    CHECK(report.failed() == 0);
    const auto t = e.samples().time();
    const auto z = e.samples().state(model::z);
    for (int k = 0; k < 31; ++k)
        CHECK(std::abs(z(1, k) - std::sin(t(1, k))) <= 1e-7);  // 4e-4 0.05^4 and the steps' errors
}

TEST_CASE("initial values that do not satisfy an algebraic equation are refused with it, or projected") {
    auto e = reactions<double>(3);
    e.state(dae::robertson::c)[2] = 0.5;
    const myriad::options o{.relative_tolerance = 1e-6, .absolute_tolerance = 1e-8};
    refused([&] { myriad::solve<rodas_5p>(tests::test_device(1), e, o); },
            {"the initial values of instance 2 do not satisfy the algebraic equation 0 = f_c", "right-hand side is 0.5",
             "myriad::make_consistent"});
    myriad::make_consistent(e);
    CHECK(e.state(dae::robertson::c)[2] == 0);
    CHECK(e.state(dae::robertson::a)[2] == 1);
    CHECK(myriad::solve<rodas_5p>(tests::test_device(1), e, o).failed() == 0);
}

TEST_CASE("a projection changes no charge: M y stays as it was") {
    auto e = amplifiers(1);
    e.state(0)[0] = 0.25;
    e.state(4)[0] = 2.5;
    refused([&] { myriad::solve<rodas_5p>(tests::test_device(1), e, {}); }, {"the algebraic equation 0 = f_u4 + f_u5"});
    const double charge_1 = e.state(1)[0] - e.state(0)[0], charge_3 = e.state(4)[0] - e.state(3)[0];
    myriad::make_consistent(e);
    CHECK(std::abs(e.state(1)[0] - e.state(0)[0] - charge_1) <= 1e-14);
    CHECK(std::abs(e.state(4)[0] - e.state(3)[0] - charge_3) <= 1e-14);
    CHECK(e.state(2)[0] == 3);
    CHECK(myriad::solve<rodas_5p>(tests::test_device(1), e, {.relative_tolerance = 1e-5}).failed() == 0);
}

TEST_CASE("algebraic states jump at stops and events, and those of differential equations stay as they are") {
    struct jump {
        double cubic, linear, from_1_on, from_event_on;
        double at_end;  // of x, which is 0 until t = 1 and then rises at the speed y to 1/2, where y becomes another
    };
    const jump jumps[] = {{1, 1, 2, -10, 0.5 - 2 * 1.5},      // y^3 + y = 2 for y = 1, and -10 for y = -2
                          {0, 1, 1, 3, 0.5 + 3 * 1.5},        // linear
                          {1, 1, 1e9 + 1e3, 1e9 + 1e3, 2e3},  // far away, for y = 1000
                          {1, 1e-6, 1, -8, 0.5 - 2 * 1.5}};   // from a derivative that is nearly zero
    constexpr std::int64_t size = 4;
    ensemble<dae::levelled> e(size);
    e.state(0) = e.state(1) = 0.0;
    e.accessory(0) = 0.0;
    e.parameter(dae::levelled::quadratic) = 0.0;
    for (std::int64_t i = 0; i < size; ++i) {
        e.parameter(dae::levelled::cubic)[i] = jumps[i].cubic;
        e.parameter(dae::levelled::linear)[i] = jumps[i].linear;
        e.parameter(dae::levelled::from_1_on)[i] = jumps[i].from_1_on;
        e.parameter(dae::levelled::from_event_on)[i] = jumps[i].from_event_on;
    }
    e.time_domain(0, 3);
    myriad::options o{.relative_tolerance = 1e-9, .absolute_tolerance = 1e-9};
    o.events = {{.direction = myriad::direction::rising}};
    CHECK(myriad::solve<rodas_5p>(tests::test_device(1), e, o).failed() == 0);
    for (std::int64_t i = 0; i < size; ++i) {
        CAPTURE(i);
        CHECK(std::abs(e.state(0)[i] / jumps[i].at_end - 1) <= 2e-6);  // y at -8 is -2 to 2e-7
    }
    CHECK(std::abs(e.state(1)[0] + 2) <= 1e-9);
}

TEST_CASE("an instance without algebraic states that satisfy their equations ends where it lost them") {
    ensemble<dae::levelled> e(2);
    for (int c = 0; c < 5; ++c) e.parameter(c) = 0.0;
    e.parameter(dae::levelled::quadratic) = 1.0;  // y^2 = 1, and 4 or -1 from t = 1 on
    e.parameter(dae::levelled::from_1_on)[0] = 4;
    e.parameter(dae::levelled::from_1_on)[1] = -1;
    e.state(0) = 1.0;
    e.state(1) = 1.0;
    e.accessory(0) = 1.0;
    e.time_domain(0, 2);
    myriad::solve<rodas_5p>(tests::test_device(1), e, {});
    CHECK(e.status(0) == myriad::status::success);
    CHECK(std::abs(e.state(0)[0] - 4) <= 1e-6);
    CHECK(e.status(1) == myriad::status::singular_jacobian);
    CHECK(e.t()[1] == 1.0);
}

TEST_CASE("a phase that starts at another time starts with algebraic states of that time") {
    using model = dae::crossed<9>;
    ensemble<model> e(2);
    for (int c = 0; c < 9; ++c) e.state(c) = 0.0;
    e.time_domain(0, 2);
    myriad::options o{.phases = 3, .relative_tolerance = 1e-9, .absolute_tolerance = 1e-9};
    CHECK(myriad::solve<rodas_5p>(tests::test_device(1), e, o).failed() == 0);
    CHECK(std::abs(e.state(model::z)[1] - std::sin(2.0)) <= 1e-7);
    CHECK(std::abs(e.state(model::w)[1] - std::sin(2.0) * std::sin(2.0)) <= 1e-7);
}

TEST_CASE("combinations of rows and directions of states without derivatives are found when a model is compiled") {
    constexpr auto& found = myriad::detail::null_spaces_of<dae::transistor_amplifier>;
    STATIC_REQUIRE(found.count == 3);
    double mass[8][8]{};
    for (const auto& entry : dae::transistor_amplifier::mass_matrix) mass[entry.row][entry.column] += entry.value;
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 8; ++i) {
            double from_left = 0, from_right = 0;
            for (int j = 0; j < 8; ++j) {
                from_left += found.left[k][j] * mass[j][i];
                from_right += mass[i][j] * found.right[k][j];
            }
            CHECK(std::abs(from_left) <= 1e-12 * 5e-6);
            CHECK(std::abs(from_right) <= 1e-12 * 5e-6);
        }
    STATIC_REQUIRE(myriad::detail::n_algebraic<dae::crossed<9>> == 2);
    STATIC_REQUIRE(myriad::detail::n_algebraic<dae::pendulum> == 1);
}

TEST_CASE("equations of a higher index are refused") {
    ensemble<dae::pendulum> e(1);
    for (int c = 0; c < 5; ++c) e.state(c) = c == 0 ? 1.0 : 0.0;
    e.time_domain(0, 1);
    refused([&] { myriad::solve<rodas_5p>(tests::test_device(1), e, {}); }, {"an index above one"});
    refused([&] { myriad::make_consistent(e); }, {"instance 0", "an index above one"});
}

TEST_CASE("a call that goes on is not compared with the algebraic equations at the start again") {
    using model = dae::crossed<9>;
    ensemble<model> e(2);
    for (int c = 0; c < 9; ++c) e.state(c) = 0.0;
    e.time_domain(0, 3);
    myriad::options o{.phases = 1, .relative_tolerance = 1e-9, .absolute_tolerance = 1e-9, .phase_length = 1};
    CHECK(myriad::solve<rodas_5p>(tests::test_device(1), e, o).failed() == 0);
    CHECK(std::abs(e.state(model::z)[0] - std::sin(1.0)) <= 1e-7);
    o.phases = 2;
    CHECK(myriad::solve<rodas_5p>(tests::test_device(1), e, o).failed() == 0);
    CHECK(std::abs(e.state(model::z)[0] - std::sin(3.0)) <= 1e-7);
}

TEST_CASE("an algebraic state that was not set is refused as such") {
    ensemble<dae::robertson> e(1);
    e.state(dae::robertson::a) = 1.0;
    e.state(dae::robertson::b) = 0.0;
    e.time_domain(0, 1);
    refused([&] { myriad::solve<rodas_5p>(tests::test_device(1), e, {}); }, {"state 2 (c)"});
}
