// SPDX-License-Identifier: MIT
// Order of convergence of whole integrations with fixed steps, through the loop that users call.
#include <cmath>
#include <limits>
#include <vector>

#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/device.hpp"

namespace {

using myriad::cash_karp;
using myriad::dormand_prince_5;
using myriad::dormand_prince_8;
using myriad::runge_kutta_4;
using myriad::tsitouras_5;
using myriad::verner_7;

/// Steps of length h and no other: adaptive methods get tolerances that no error exceeds.
myriad::options fixed_step(double h) {
    myriad::options o;
    o.step = o.minimum_step = o.maximum_step = h;
    o.relative_tolerance = o.absolute_tolerance = 1e30;
    return o;
}

/// Root mean square error at the end of instances that start at different times, so that no symmetry hides an error term.
template <class Method, class Model, class R = double>
double end_error(double h, double span) {
    myriad::ensemble<Model, R> e(16);
    constexpr int n = Model::n_state;
    for (std::int64_t i = 0; i < e.size(); ++i) {
        e.t_begin()[i] = static_cast<R>(0.5 + 0.125 * static_cast<double>(i));
        e.t_end()[i] = e.t_begin()[i] + static_cast<R>(span);
        const auto start = Model::exact(e.t_begin()[i]);
        for (int c = 0; c < n; ++c) e.state(c)[i] = start[c];
    }
    const auto report = myriad::solve<Method>(tests::test_device(1), e, fixed_step(h));
    REQUIRE(report.count(myriad::status::success) == e.size());
    // the step must be the one asked for, or the order measured is not the method's
    REQUIRE(report.accepted_steps == e.size() * static_cast<std::int64_t>(std::lround(std::abs(span) / h)));
    REQUIRE(report.rejected_steps == 0);
    double squares = 0;
    for (std::int64_t i = 0; i < e.size(); ++i) {
        const auto end = Model::exact(static_cast<double>(e.t_end()[i]));
        for (int c = 0; c < n; ++c) squares += std::pow(static_cast<double>(e.state(c)[i]) - end[c], 2);
    }
    return std::sqrt(squares / static_cast<double>(e.size()));
}

struct window {
    double below, above;
};

/// The global error is C h^order (1 + O(h)).
template <class Method, class Model, class R = double>
void check_order(double order, double first_h, double span, window allowed = {0.1, 0.1}) {
    double h = first_h, coarse = end_error<Method, Model, R>(h, span);
    std::vector<double> slopes;
    for (int i = 0; i < 3; ++i) {
        h /= 2;
        const double fine = end_error<Method, Model, R>(h, span);
        slopes.push_back(std::log2(coarse / fine));
        coarse = fine;
    }
    CAPTURE(span, first_h, slopes, coarse);
    // the roundings of N steps add up to about sqrt(N) eps
    REQUIRE(coarse > 10 * std::sqrt(std::abs(span) / h) * static_cast<double>(std::numeric_limits<R>::epsilon()));
    CHECK(slopes[2] > order - allowed.below);
    CHECK(slopes[2] < order + allowed.above);
}

/// Forwards and backwards, with and without time in the right-hand side.
template <class Method>
void check_order_everywhere(double order, window allowed) {
    check_order<Method, problems::log_circle>(order, 0.125, 2, allowed);
    check_order<Method, problems::log_circle>(order, 0.125, -2, allowed);
    check_order<Method, problems::timed_circle>(order, 0.03125, 1, allowed);
    check_order<Method, problems::timed_circle>(order, 0.03125, -1, allowed);
    check_order<Method, problems::oscillator>(order, 0.125, 2);
}

}  // namespace

TEST_CASE("runge_kutta_4 has order four") { check_order_everywhere<runge_kutta_4>(4, {0.1, 0.1}); }
TEST_CASE("cash_karp has order five") { check_order_everywhere<cash_karp>(5, {0.1, 0.1}); }
// Its leading error coefficients are so small (2e-4 at most) that on the nonlinear problems the next term, with slope six,
// counts until rounding does; the linear oscillator shows that it is five.
TEST_CASE("tsitouras_5 has order five") { check_order_everywhere<tsitouras_5>(5, {0.1, 0.7}); }
TEST_CASE("dormand_prince_5 has order five") { check_order_everywhere<dormand_prince_5>(5, {0.1, 0.7}); }
// On the nonlinear problems rounding comes before the leading term does; on the oscillator it does not.
TEST_CASE("verner_7 has order seven") {
    check_order<verner_7, problems::oscillator>(7, 1, 16);
    check_order<verner_7, problems::log_circle>(7, 0.5, 2, {0.1, 3});
    check_order<verner_7, problems::timed_circle>(7, 0.125, 1, {0.1, 3});
}
TEST_CASE("dormand_prince_8 has order eight") {
    check_order<dormand_prince_8, problems::oscillator>(8, 2, 16);
    check_order<dormand_prince_8, problems::log_circle>(8, 1, 2, {0.15, 0.3});
    check_order<dormand_prince_8, problems::timed_circle>(8, 0.25, 1, {0.15, 0.3});
}

TEST_CASE("runge_kutta_4 has order four in single precision") {
    check_order<runge_kutta_4, problems::oscillator, float>(4, 1.0, 4, {0.2, 0.2});  // h of 1/8: few steps before rounding
}
