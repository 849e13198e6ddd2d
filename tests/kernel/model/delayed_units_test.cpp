// SPDX-License-Identifier: MIT
// Coupled units with delays are the system that they stand for, and oscillators that see each other late have the
// frequency of the theory.
#include "tests/kernel/model/delayed_units.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <Eigen/Dense>
#include <myriad/myriad.hpp>

#include "myriad/kernel/event/breaking_points.hpp"
#include "myriad/kernel/model/delays_of_units.hpp"
#include "tests/catch.hpp"
#include "tests/kernel/model/delayed_teams.hpp"
#include "tests/support/device.hpp"

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using namespace delayed_units;
using Catch::Matchers::Contains;

/// Both have the same values everywhere: to the bit on the CPU, whose arithmetic is as written.
template <class A, class B>
void check_same(const myriad::ensemble<A>& a, const myriad::ensemble<B>& b) {
    const double allowed = tests::tests_cpu() ? 0 : 1e4 * std::numeric_limits<double>::epsilon();
    for (Index i = 0; i < a.size(); ++i) {
        REQUIRE(a.status(i) == myriad::status::success);
        REQUIRE(b.status(i) == myriad::status::success);
        for (int c = 0; c < A::n_state; ++c) {
            CAPTURE(i, c);
            CHECK(std::abs(a.state(c)[i] - b.state(c)[i]) <= allowed);
        }
    }
}
/// Solves both, filled alike.
template <class Method, class A, class B, class Fill>
void compare(Index size, const myriad::options& options, const Fill& fill) {
    myriad::ensemble<A> a(size);
    myriad::ensemble<B> b(size);
    fill(a);
    fill(b);
    myriad::solve<Method>(tests::test_device(), a, options);
    myriad::solve<Method>(tests::test_device(), b, options);
    check_same(a, b);
}

constexpr auto fill_phases = [](auto& e) {
    using model = typename std::remove_cvref_t<decltype(e)>::model;
    constexpr int n = model::n_parameter - 2;
    e.parameter(0) = 0.9;
    e.parameter(1) = Eigen::ArrayXd::LinSpaced(e.size(), 0.4, 2.5);
    for (int i = 0; i < n; ++i) {
        e.parameter(2 + i) = 1 + 0.05 * i;
        e.state(i) = Eigen::ArrayXd::LinSpaced(e.size(), 0.3 * i, 0.5 * i);
        for (int j = 0; j < n; ++j) e.shared(j * n + i) = (1 + 0.1 * ((i + 2 * j) % 5)) / n;
    }
    for (int i = n; i < model::n_state; ++i) e.state(i) = 1.0 / i;
    e.time_domain(0, 12);
};

}  // namespace

TEST_CASE("Units that see each other late are the system that is written as a whole", "[coupled_units]") {
    myriad::options options;
    options.relative_tolerance = options.absolute_tolerance = 1e-9;
    compare<myriad::tsitouras_5, phases<5>, written_phases<5>>(11, options, fill_phases);
    compare<myriad::dormand_prince_5, phases<20>, written_phases<20>>(3, options, fill_phases);
    options.step = 0.05;
    compare<myriad::runge_kutta_4, phases<5>, written_phases<5>>(5, options, fill_phases);
}

TEST_CASE("Tangents of units with delays are those of the system that is written as a whole", "[coupled_units]") {
    myriad::options options;
    options.relative_tolerance = options.absolute_tolerance = 1e-9;
    compare<myriad::tsitouras_5, phases_with_tangent, written_with_tangent>(3, options, fill_phases);
}

TEST_CASE("Units with a conduction time from each neighbour are the system that is written as a whole",
          "[coupled_units]") {
    const auto fill = [](auto& e) {
        e.parameter(0) = Eigen::ArrayXd::LinSpaced(e.size(), 0.5, 2);
        e.parameter(1) = 1.2;
        for (int i = 0; i < cell::units; ++i) {
            e.parameter(2 + 2 * i) = 0.3 + 0.2 * i;
            e.parameter(3 + 2 * i) = 1.7 - 0.15 * i;
            e.state(2 * i) = std::cos(i) + 0.1;
            e.state(2 * i + 1) = 0.0;
        }
        e.time_domain(0, 15);
    };
    myriad::options options;
    options.relative_tolerance = options.absolute_tolerance = 1e-9;
    options.history_steps = 2048;  // each jump arrives by 12 lags
    myriad::ensemble<cells> a(7);
    myriad::ensemble<written_cells> b(7);
    fill(a);
    fill(b);
    myriad::solve<myriad::dormand_prince_5>(tests::test_device(), a, options);
    myriad::solve<myriad::dormand_prince_5>(tests::test_device(), b, options);
    check_same(a, b);
    for (int i = 0; i < cell::units; ++i) {
        CHECK(a.state(2 * i + 1).minCoeff() > 1);  // events were there
        CHECK((a.accessory(i) - b.accessory(i)).abs().maxCoeff() <= (tests::tests_cpu() ? 0 : 1e-11));
    }
}

TEST_CASE("Units with lags by time and state, slopes and some histories are the system that is written as a whole",
          "[coupled_units]") {
    const auto fill = [](auto& e) {
        for (int i = 0; i < 3; ++i) {
            e.shared(i) = 0.2 + 0.1 * i;
            e.state(2 * i) = Eigen::ArrayXd::LinSpaced(e.size(), i, 1 + i);
            e.state(2 * i + 1) = 0.5;
        }
        e.time_domain(0, 6);
    };
    myriad::options options;
    options.relative_tolerance = options.absolute_tolerance = 1e-6;
    options.history_steps = 4096;
    compare<myriad::dormand_prince_5, changing_units, written_changing>(5, options, fill);
    compare<myriad::rodas_5p, changing_units, written_changing>(5, options, fill);
}

TEST_CASE("Oscillators that see each other late are synchronised at the frequency of the theory", "[coupled_units]") {
    constexpr int n = 20;
    constexpr double omega = 1, strength = 0.6, t_end = 200;
    myriad::ensemble<phases<n>> e(4);
    e.parameter(phase::K) = strength;
    e.parameter(phase::tau) = Eigen::ArrayXd::LinSpaced(4, 0.2, 1.1);
    for (int i = 0; i < n; ++i) {
        e.parameter(phases<n>::parameter_of(i, phase::omega)) = omega;
        e.state(phases<n>::state_of(i, phase::theta)) = 0.02 * i;
    }
    myriad::set_coupling(e, 0, MatrixXd::Constant(n, n, 1.0 / n));
    myriad::options options;
    options.relative_tolerance = options.absolute_tolerance = 1e-10;
    e.time_domain(0, t_end);
    const auto solver = [&] { myriad::solve<myriad::dormand_prince_5>(tests::test_device(), e, options); };
    solver();
    const Eigen::ArrayXd before = e.state(0);
    e.time_domain(t_end, t_end + 10);
    solver();
    for (Index i = 0; i < e.size(); ++i) {
        REQUIRE(e.status(i) == myriad::status::success);
        double frequency = omega;
        for (int k = 0; k < 200; ++k) frequency = omega - strength * std::sin(frequency * e.parameter(phase::tau)[i]);
        CHECK(std::abs((e.state(0)[i] - before[i]) / 10 - frequency) < 1e-9);
        CHECK(std::abs(e.state(0)[i] - e.state(n - 1)[i]) < 1e-8);
    }
}

TEST_CASE("What units keep of their past is told and is part of the memory that is needed", "[coupled_units]") {
    CHECK_THAT(myriad::describe<cells>(), Contains("lag (18 values)"));
    // Each state is kept once, however many units read it.
    CHECK(myriad::detail::n_kept<cells> == 6);
    CHECK(myriad::detail::n_lag<cells> == 12);
    CHECK(myriad::detail::n_lag<phases<20>> == 1);
    CHECK(myriad::detail::n_kept<phases<20>> == 20);
    // binomial(12 + 3, 3) = 455 jumps, and binomial(12 + 4, 4) = 1820
    CHECK(myriad::detail::highest_jump<cells>(5) == 3);
    CHECK(myriad::detail::highest_jump<phases<20>>(9) == 9);
    // binomial(81 + 2, 2) = 3403 and binomial(81 + 3, 3) = 95 284; binomial(400 + 2, 2) = 80 601
    CHECK(myriad::detail::highest_jump<delayed_teams::pairs_of<9>>(5) == 2);
    CHECK(myriad::detail::highest_jump<delayed_teams::pairs_of<20>>(5) == 1);
}

TEST_CASE("Lags of units that cannot be, and a ring that is too short, are statuses", "[coupled_units]") {
    myriad::ensemble<phases<5>> e(3);
    fill_phases(e);
    e.parameter(phase::tau)[0] = 0;
    e.parameter(phase::tau)[2] = 11;
    myriad::options options;
    options.relative_tolerance = options.absolute_tolerance = 1e-9;
    options.history_steps = 16;
    e.time_domain(0, 25);
    myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, options);
    CHECK(e.status(0) == myriad::status::invalid_delay);
    CHECK(e.status(2) == myriad::status::history_overflow);
}
