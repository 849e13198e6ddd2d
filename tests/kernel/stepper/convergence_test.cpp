// SPDX-License-Identifier: MIT
// Order of convergence of whole integrations with fixed steps, through the loop that users call.
#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/kernel/stepper/global_order.hpp"
#include "tests/support/problems.hpp"

namespace {

using global_order::check_order;
using global_order::window;
using myriad::cash_karp;
using myriad::dormand_prince_5;
using myriad::dormand_prince_8;
using myriad::runge_kutta_4;
using myriad::tsitouras_5;
using myriad::verner_7;
using myriad::verner_9;

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
// Its leading error coefficients are so small (2e-4 at most) that on the nonlinear problems the next term, with slope
// six, dominates until rounding does; the linear oscillator shows the order five.
TEST_CASE("tsitouras_5 has order five") { check_order_everywhere<tsitouras_5>(5, {0.1, 0.7}); }
TEST_CASE("dormand_prince_5 has order five") { check_order_everywhere<dormand_prince_5>(5, {0.1, 0.7}); }
// On the nonlinear problems rounding dominates before the leading term does; not on the oscillator.
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
// The nonlinear problems have only rounding errors left before three halvings.
TEST_CASE("verner_9 has order nine") { check_order<verner_9, problems::oscillator>(9, 2, 16, {0.1, 0.5}); }

TEST_CASE("runge_kutta_4 has order four in single precision") {
    check_order<runge_kutta_4, problems::oscillator, float>(4, 1.0, 4,
                                                            {0.2, 0.2});  // h of 1/8: few steps before rounding
}
