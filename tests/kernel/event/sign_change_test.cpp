// SPDX-License-Identifier: MIT
// Every change of sign between the points where functions are evaluated is an event, whatever the function's size and
// however long the steps; a tolerance says only how closely it is located. A function that touches zero has no event.
#include "tests/catch.hpp"
#include "tests/kernel/event/levels.hpp"
#include "tests/kernel/event/logged_motions.hpp"
#include "tests/kernel/event/time_models.hpp"
#include "tests/support/device.hpp"

using namespace logged_motions;
using myriad::direction;

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// x' = 1, and x falls back by one where it reaches one.
template <class Method, class R = double>
myriad::ensemble<logged_motion, R> counter(double x, double t_end, int action, myriad::options o) {
    auto e = ensemble_of<R>(motion{.x = x, .v = 1}, {position(t_end < 0 ? -1 : 1, action), never(), never()}, 0, t_end);
    o.events.resize(3);
    if (std::is_same_v<Method, myriad::runge_kutta_4>) o.step = 0.7;  // else of any length
    myriad::solve<Method>(tests::test_device(1), e, o);
    return e;
}

/// The double root of a point that moves with speed one to its level at t = 1.
template <class Method>
myriad::ensemble<levels> touching(double t_end, double v, myriad::options o) {
    myriad::ensemble<levels> e(1);
    e.state(levels::x) = 0;
    e.state(levels::v) = v;
    for (int c = 0; c < levels::n_parameter; ++c) e.parameter(c) = c == levels::a ? 0.0 : v;
    for (int j = 0; j < 3; ++j) {
        e.shared_integer(levels::kind + j) = j == 0 ? levels::touch : levels::none;
        e.shared_integer(levels::action + j) = levels::log;
    }
    e.shared_integer(levels::counts_steps) = 0;
    e.time_domain(0, t_end);
    myriad::solve<Method>(tests::test_device(1), e, o);
    return e;
}

}  // namespace

TEMPLATE_TEST_CASE("the crossings of a small or a large event function are found", "", ALL_METHODS) {
    // x = size sin t against size / 2: seven crossings, and the same of other sizes
    std::vector<double> expected;
    for (int n = 0; n < 4; ++n)
        for (const double t : {2 * pi * n + pi / 6, 2 * pi * n + 5 * pi / 6})
            if (t < 20) expected.push_back(t);
    REQUIRE(expected.size() == 7);
    for (const double size : {1e-300, 1e-30, 1e-7, 1.0, 1e30, 1e300}) {
        for (const double tolerance : {0.0, 1e-6}) {
            CAPTURE(size, tolerance);
            auto e = ensemble_of(motion{.x = 0, .v = size, .k = 1}, {position(0.5 * size), never(), never()}, 0, 20);
            auto o = options_for(tolerance, 1e-3);
            o.absolute_tolerance = 1e-13 * size;
            o.maximum_step = 0.02;
            solve_unchecked<TestType>(e, o);
            CHECK(e.status(0) == myriad::status::success);
            // The tolerance counts as 1/64 of the function's change in a step at most.
            CHECK(agree(times_of(e), expected, tolerance > size * 1e-3 ? 0.02 / 32 : 1e-6));
        }
    }
}

TEMPLATE_TEST_CASE("a function much smaller than its tolerance fires as often as it crosses", "", ALL_METHODS) {
    auto e = ensemble_of(motion{.x = 1e-9, .k = 1}, {position(), never(), never()}, 0, 1000);
    auto o = options_for(1e-6, 1e-2);
    o.relative_tolerance = 1e-10;
    o.absolute_tolerance = 1e-19;
    solve<TestType>(e, o);
    CHECK(e.status(0) == myriad::status::success);
    CHECK(count_of(e) == 318);
}

TEMPLATE_TEST_CASE("without a tolerance an event is located to rounding", "", ALL_METHODS) {
    for (const double c : {0.1, 0.3, 1.0 / 3, 0.77}) {
        auto e = ensemble_of(motion{.v = 1}, {position(c), time(c + 0.1), never()}, 0, 1);
        solve<TestType>(e, options_for(0, 0.07));
        CHECK(agree(times_of(e, 0), {c}, 4 * epsilon));
        CHECK(agree(times_of(e, 1), {c + 0.1}, 4 * epsilon));
    }
    auto e = ensemble_of(sine, {position(), velocity(), never()}, 0, 100);
    const auto report = solve<TestType>(e, options_for(0, 0.01));
    CHECK(count_of(e) == 63);
    CHECK(e.accessory(logged_motion::gap)[0] <= 1e-16);
    CHECK(e.accessory(logged_motion::beyond)[0] <= 1e-16);
    CHECK(report.located_steps <= 4 * 63);
}

TEMPLATE_TEST_CASE("a state that is set back at its event fires every time, however long the next step is", "",
                   ALL_METHODS, myriad::dormand_prince_8) {
    for (const double t_end : {1000.5, 10000.5, -1000.5}) {
        for (const int action : {logged_motion::zero_x, logged_motion::lower_x}) {
            if (t_end < 0 && action == logged_motion::lower_x) continue;
            CAPTURE(t_end, action);
            auto o = myriad::options{};
            const auto e = counter<TestType>(0, t_end, action, o);
            CHECK(e.status(0) == myriad::status::success);
            CHECK(count_of(e) == static_cast<int>(std::abs(t_end)));
            CHECK(std::abs(std::abs(e.state(logged_motion::x)[0]) - 0.5) <= 1e-9);
        }
    }
}

TEMPLATE_TEST_CASE("no state passes its event when the steps could be as long as the domain", "", ALL_METHODS) {
    myriad::options o;
    o.max_steps = 30000;
    const auto e = counter<TestType>(0, 1e8, logged_motion::zero_x, o);
    CHECK(e.status(0) == myriad::status::max_steps);
    CHECK(std::abs(e.t()[0] - count_of(e)) <= 1 + 1e-9);
    CHECK(std::abs(e.state(logged_motion::x)[0]) <= 1 + 1e-9);
    // from far away: the first step is 1e8 times longer than all that follow
    o.max_steps = 10'000'000;
    const auto far = counter<TestType>(-1e4, 1e4 + 100.5, logged_motion::lower_x, o);
    CHECK(far.status(0) == myriad::status::success);
    CHECK(count_of(far) == 100);
}

TEST_CASE("a float state that is set back at its event fires every time, however long the next step is") {
    for (const double t_end : {1000.5, 5000.5}) {
        CAPTURE(t_end);
        const auto a = counter<myriad::dormand_prince_8, float>(0, t_end, logged_motion::zero_x, {});
        CHECK(a.status(0) == myriad::status::success);
        CHECK(count_of(a) == static_cast<int>(t_end));
        const auto b = counter<myriad::tsitouras_5, float>(0, t_end, logged_motion::zero_x, {});
        CHECK(b.status(0) == myriad::status::success);
        CHECK(count_of(b) == static_cast<int>(t_end));
    }
}

TEMPLATE_TEST_CASE("a double root at t_end does not fire, nor when time goes on", "", ALL_METHODS) {
    myriad::options o;
    o.phase_time = myriad::phase_time::carry_on;
    o.relative_tolerance = o.absolute_tolerance = 1e-10;
    for (const double tolerance : {0.0, 1e-9, 1e-6}) {
        for (const double step : {0.01, 0.1, 0.37}) {
            for (const double v : {1.0, 0.3}) {
                CAPTURE(tolerance, step, v);
                o.step = o.maximum_step = step;
                o.events.assign(3, {.tolerance = tolerance});
                auto e = touching<TestType>(1, v, o);
                CHECK(e.integer_accessory(levels::fired)[0] == 0);
                e.t_end() = 2;
                myriad::solve<TestType>(tests::test_device(1), e, o);
                CHECK(e.t()[0] == 2);
                CHECK(e.integer_accessory(levels::fired)[0] == 0);
            }
            // (t - 1)^2, cos t - 1, and x - 1 for x = sin t
            o.events.assign(3, {.tolerance = tolerance});
            auto e = ensemble_of(motion{}, {function{.Q = 1}, never(), never()}, 0, 1);
            for (const double t_end : {1.0, 2.0}) {
                e.t_end() = t_end;
                solve<TestType>(e, o);
                CHECK(count_of(e) == 0);
            }
            o.events.resize(1);
            myriad::ensemble<wave> w(1);
            w.state(wave::x) = 1;
            w.parameter(wave::amplitude) = 1;
            w.parameter(wave::c) = -1;
            w.time_domain(1, 2 * pi);
            for (const double t_end : {2 * pi, 7.0}) {
                w.t_end() = t_end;
                myriad::solve<TestType>(tests::test_device(1), w, o);
                CHECK(w.integer_accessory(wave::fired)[0] == 0);
            }
        }
    }
}

TEMPLATE_TEST_CASE("a solution that comes to its level at rest at t_end does not fire", "", ALL_METHODS) {
    for (const double tolerance : {0.0, 1e-9, 1e-6}) {
        for (const double step : {1e-3, 0.01}) {
            for (const double below : {0.0, 1e-13, 1e-9}) {
                CAPTURE(tolerance, step, below);
                // x = 1 - (t - 1)^2 / 2 reaches 1 exactly, or not at all
                auto e = ensemble_of(motion{.x = 0.5, .v = 1, .a = -1}, {position(1 + below), never(), never()}, 0, 1);
                auto o = options_for(tolerance, step);
                o.phase_time = myriad::phase_time::carry_on;
                for (const double t_end : {1.0, 2.0}) {
                    e.t_end() = t_end;
                    solve_unchecked<TestType>(e, o);
                    CHECK(count_of(e) <= (below > 0 ? 0 : 2));
                    if (t_end == 1) CHECK(count_of(e) == 0);
                }
            }
        }
    }
}
