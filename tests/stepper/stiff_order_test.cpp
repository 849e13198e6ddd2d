// SPDX-License-Identifier: MIT
// Order of convergence of the stiff methods over whole integrations with fixed steps: on problems that are not stiff, and
// on Prothero and Robinson's, where stiffness reduces it.
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/stepper/global_order.hpp"
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

struct expected_slope {
    double rate, first_h, order, window;
};

template <class Method>
void check_stiff_order(const expected_slope& expected) {
    double h = expected.first_h, coarse = prothero_robinson_error<Method>(expected.rate, h);
    std::vector<double> slopes;
    for (int i = 0; i < 3; ++i) {
        h /= 2;
        const double fine = prothero_robinson_error<Method>(expected.rate, h);
        slopes.push_back(std::log2(coarse / fine));
        coarse = fine;
    }
    CAPTURE(expected.rate, slopes, coarse);
    CHECK(false);
}

}  // namespace

TEST_CASE("rosenbrock_23 has order two") { check_order<rosenbrock_23, problems::timed_circle>(2, 1.0 / 128, 1); }
TEST_CASE("rodas_5p has order five") { check_order<rodas_5p, problems::timed_circle>(5, 1.0 / 32, 1); }
TEST_CASE("rosenbrock_23 has order two in single precision") { check_order<rosenbrock_23, problems::oscillator, float>(2, 0.25, 2, {0.2, 0.2}); }
TEST_CASE("rodas_5p has order five in single precision") { check_order<rodas_5p, problems::oscillator, float>(5, 2.0, 8, {0.3, 0.3}); }

TEST_CASE("PR") {
    for (double rate : {1.0, 1e2,1e4,1e6}) { check_stiff_order<rosenbrock_23>({rate, 0.25, 2, 0.1}); check_stiff_order<rodas_5p>({rate, 0.25, 3, 0.1}); }
}
