// SPDX-License-Identifier: MIT
// Order of convergence of the stiff methods over whole integrations with fixed steps: on non-stiff problems, and on
// Prothero and Robinson's, where stiffness reduces it.
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/kernel/stepper/global_order.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/stiff.hpp"

namespace {

using global_order::check_order;
using myriad::rodas_5p;
using myriad::rosenbrock_23;
using stiff::prothero_robinson;

/// Root mean square error over instances that start on the solution sin t at different times, after a time of 1.
template <class Method>
double prothero_robinson_error(double rate, double h) {
    myriad::ensemble<prothero_robinson> e(16);
    e.parameter(prothero_robinson::rate) = rate;
    for (std::int64_t i = 0; i < e.size(); ++i) {
        e.t_begin()[i] = 0.25 * static_cast<double>(i);
        e.t_end()[i] = e.t_begin()[i] + 1;
        e.state(0)[i] = std::sin(e.t_begin()[i]);
    }
    const auto report = myriad::solve<Method>(tests::test_device(1), e, compare::fixed_step(h));
    REQUIRE(report.count(myriad::status::success) == e.size());
    REQUIRE(report.accepted_steps == e.size() * std::lround(1 / h));
    double squares = 0;
    for (std::int64_t i = 0; i < e.size(); ++i) squares += std::pow(e.state(0)[i] - std::sin(e.t_end()[i]), 2);
    return std::sqrt(squares / static_cast<double>(e.size()));
}

/// The last slope of three from h = 1/4 to 1/32 (or from `first_h` on).
template <class Method>
void check_stiff_order(double rate, double least, double most, double first_h = 0.25) {
    double h = first_h, coarse = prothero_robinson_error<Method>(rate, h);
    std::vector<double> slopes;
    for (int i = 0; i < 3; ++i) {
        h /= 2;
        const double fine = prothero_robinson_error<Method>(rate, h);
        slopes.push_back(std::log2(coarse / fine));
        coarse = fine;
    }
    CAPTURE(rate, slopes, coarse);
    REQUIRE(coarse >
            10 * std::numeric_limits<double>::epsilon());  // the problem forgets the roundings of earlier steps
    CHECK(slopes[2] > least);
    CHECK(slopes[2] < most);
}

}  // namespace

TEST_CASE("rosenbrock_23 has order two") { check_order<rosenbrock_23, problems::timed_circle>(2, 1.0 / 128, 1); }
TEST_CASE("rodas_5p has order five") { check_order<rodas_5p, problems::timed_circle>(5, 1.0 / 32, 1); }
TEST_CASE("rosenbrock_23 has order two in single precision") {
    check_order<rosenbrock_23, problems::oscillator, float>(2, 0.25, 2, {0.2, 0.2});
}

// Its coefficients magnify rounding some hundred times, which leaves no range in which to measure an order in single
// precision.
TEST_CASE("rodas_5p keeps a tolerance in single precision") {
    using problems::oscillator;
    const double tolerance = 1e-4;
    myriad::ensemble<oscillator, float> e(1);
    e.state(oscillator::x) = 1.0f;
    e.state(oscillator::v) = 0.0f;
    e.time_domain(0.0f, 8.0f);
    const auto report = myriad::solve<rodas_5p>(tests::test_device(1), e, compare::with_tolerance(tolerance, 0.1));
    REQUIRE(report.count(myriad::status::success) == 1);
    // a rotation: the errors of the steps in both components add up
    const double bound = std::sqrt(2.0) * tolerance * static_cast<double>(report.accepted_steps);
    CHECK(std::abs(static_cast<double>(e.state(oscillator::x)[0]) - std::cos(8.0)) <= bound);
    CHECK(std::abs(static_cast<double>(e.state(oscillator::v)[0]) + std::sin(8.0)) <= bound);
}

// A wrong term in df/dt is multiplied by the rate and shows at once.
TEST_CASE("rosenbrock_23 keeps order two on Prothero and Robinson's problem, however stiff it is") {
    for (const double rate : {1.0, 1e2, 1e4, 1e6}) check_stiff_order<rosenbrock_23>(rate, 1.95, 2.05);
}
// Stiff order three, for which it was designed; other methods of its kind drop to one. The tableau's order shows where
// h times the rate is small, and returns slowly on the way there.
TEST_CASE(
    "rodas_5p has order three on Prothero and Robinson's problem where it is very stiff, and five where it is not") {
    check_stiff_order<rodas_5p>(1.0, 4.9, 5.1);
    check_stiff_order<rodas_5p>(1e2, 4.5, 5.1, 0.125);
    check_stiff_order<rodas_5p>(1e4, 3.0, 3.5);
    check_stiff_order<rodas_5p>(1e6, 2.95, 3.05);
}
