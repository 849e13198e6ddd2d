// SPDX-License-Identifier: MIT
// Where an integration begins and ends: the end of the domain to the last bit and without a sliver step, empty, endless
// and backward domains.
#include <cmath>
#include <limits>
#include <vector>

#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/device.hpp"
#include "tests/support/hooked.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/recorder.hpp"

namespace {

using compare::each_adaptive_method;
using compare::each_method;
using compare::fixed_step;
using compare::with_tolerance;
using myriad::device;
using myriad::ensemble;
using myriad::options;
using myriad::runge_kutta_4;
using myriad::solve;
using myriad::status;
using recorder::recorded;

using uniform = recorded<problems::uniform>;  // y' = 1, steps logged

template <class R>
constexpr R eps = std::numeric_limits<R>::epsilon();

/// y' = 1 over a domain: the ensemble afterwards, its steps in the log.
template <class Method, class R>
ensemble<uniform, R> run(R t_begin, R t_end, const options& o) {
    ensemble<uniform, R> e(1);
    e.state(0) = t_begin;
    e.time_domain(t_begin, t_end);
    recorder::take();
    solve<Method>(tests::test_device(1), e, o);
    REQUIRE(e.status(0) == status::success);
    return e;
}

template <class Method, class R>
void check_steps(R t_begin, R t_end, const options& o, std::int64_t steps) {
    CAPTURE(t_begin, t_end, o.step);
    const auto e = run<Method, R>(t_begin, t_end, o);
    CHECK(e.accepted_steps()[0] == steps);
    CHECK(e.rejected_steps()[0] == 0);
    CHECK(e.t()[0] == t_end);
    // N sums, each rounded by half an ulp of values up to |t|, of increments h sum b_i, whose weights are rounded too
    const R size = std::max({std::abs(t_begin), std::abs(t_end), R(1)});
    const R h = std::min(static_cast<R>(o.step), std::abs(t_end - t_begin));
    CHECK(std::abs(e.state(0)[0] - t_end) <= static_cast<R>(steps) * eps<R> * (size / 2 + 4 * h));
}

}  // namespace

TEST_CASE("10000 steps of a thousandth over [0, 10] are 10000 steps") {
    each_method([]<class Method> { check_steps<Method>(0.0, 10.0, fixed_step(1e-3), 10000); });
}
TEST_CASE("10000 steps of a thousandth over [0, 10] are 10000 steps in single precision") {
    each_method([]<class Method> { check_steps<Method>(0.0f, 10.0f, fixed_step(1e-3), 10000); });
}
TEST_CASE("100000 steps of a ten-thousandth over [0, 10] are 100000 steps in single precision") {
    // Near t = 10 the rounding of t would lose a hundredth of every step if it were not kept; and the last step but one
    // may be rounded to the end itself.
    each_method([]<class Method> { check_steps<Method>(0.0f, 10.0f, fixed_step(1e-4), 100000); });
}
TEST_CASE("10000 steps of a thousandth back from 10 to 0 are 10000 steps") {
    each_method([]<class Method> {
        check_steps<Method>(10.0, 0.0, fixed_step(1e-3), 10000);
        check_steps<Method>(10.0f, 0.0f, fixed_step(1e-3), 10000);
    });
}
TEST_CASE("three steps of 0.1 over [0, 0.3] are three steps") {
    // 0.3 / 0.1 < 3 and 0.1 + 0.1 + 0.1 > 0.3 in double precision
    each_method([]<class Method> {
        check_steps<Method>(0.0, 0.3, fixed_step(0.1), 3);
        check_steps<Method>(0.0, 0.1 + 0.1 + 0.1, fixed_step(0.1), 3);
        check_steps<Method>(0.0, -0.3, fixed_step(0.1), 3);
        check_steps<Method>(0.0f, 0.3f, fixed_step(0.1), 3);
    });
}
TEST_CASE("a domain of n steps up to rounding has n steps, for every n") {
    each_method([]<class Method> {
        ensemble<problems::oscillator> e(400);
        e.state(0) = 1.0;
        e.state(1) = 0.0;
        double sum = 0;
        for (std::int64_t i = 0; i < e.size(); i += 2) {
            const auto n = static_cast<double>(i / 2 + 1);
            sum += 0.1;
            e.t_begin()[i] = e.t_begin()[i + 1] = 0;
            e.t_end()[i] = n * 0.1;
            e.t_end()[i + 1] = sum;
        }
        solve<Method>(tests::test_device(1), e, fixed_step(0.1));
        for (std::int64_t i = 0; i < e.size(); ++i) {
            CAPTURE(i);
            CHECK(e.accepted_steps()[i] == i / 2 + 1);
            CHECK(e.t()[i] == e.t_end()[i]);
        }
    });
}
TEST_CASE("a thousand steps far from t = 0 are a thousand steps") {
    each_method([]<class Method> { check_steps<Method>(1e9, 1e9 + 1, fixed_step(1e-3), 1000); });
}
TEST_CASE("the state advances by as much as t, however coarse the resolution of t") {
    each_method([]<class Method> {
        const auto check = [](double t_begin, double length, double step, double tolerance) {
            CAPTURE(t_begin, length, step);
            options o = fixed_step(step);
            o.minimum_step = 0;  // steps may be rounded to shorter ones
            ensemble<uniform> e(1);
            e.state(0) = 0;
            e.time_domain(t_begin, t_begin + length);
            recorder::take();
            solve<Method>(tests::test_device(1), e, o);
            CHECK(e.status(0) == status::success);
            CHECK(std::abs(e.state(0)[0] - length) <= tolerance);
        };
        // t is a multiple of two at 1e16, and of 2^-23 at 1e9; the sums of the state are rounded to a few 1e-13
        for (const double direction : {1.0, -1.0}) {
            check(1e16, direction * 1000, 3, 1e-9);
            check(1e9, direction * 1000, 0.1, 1e-9);
            check(1e9, direction, 1e-5, 1e-9);
        }
    });
}

TEST_CASE("an oscillator far from t = 0 ends where it does near it") {
    each_method([]<class Method> {
        const auto end = [](double t_begin) {
            options o = with_tolerance(1e-10, 1e-3);
            o.maximum_step = 1e-3;
            ensemble<problems::oscillator> e(1);
            e.state(problems::oscillator::x) = 1;
            e.state(problems::oscillator::v) = 0;
            e.time_domain(t_begin, t_begin + 64);
            solve<Method>(tests::test_device(1), e, o);
            return e.state(problems::oscillator::x)[0];
        };
        // 64 000 steps, each rounded by half an ulp of one at most
        for (const double t_begin : {0.0, 1e6, 1e9}) {
            CAPTURE(t_begin);
            CHECK(std::abs(end(t_begin) - std::cos(64.0)) <= 64'000 * eps<double> / 2);
        }
    });
}

TEST_CASE("a remainder of the domain gets a step of its own") {
    each_method([]<class Method> {
        check_steps<Method>(0.0, 1.0, fixed_step(0.3), 4);
        CHECK(std::abs(recorder::take().back().h - 0.1) <= 2 * eps<double>);  // 1 - 3 * 0.3, of rounded numbers
        check_steps<Method>(0.0, -1.0, fixed_step(0.3), 4);
        CHECK(std::abs(recorder::take().back().h + 0.1) <= 2 * eps<double>);
        check_steps<Method>(0.0f, 1.0f, fixed_step(0.3), 4);
    });
}
TEST_CASE("a sliver of a domain is added to the last step") {
    each_method([]<class Method> {
        check_steps<Method>(0.0, 3 + 1e-7, fixed_step(1), 3);
        const auto steps = recorder::take();
        CHECK(std::abs(steps.back().h - (1 + 1e-7)) <= 4 * eps<double>);  // differences of numbers below 4
        CHECK(steps.back().t == 3 + 1e-7);
    });
}
TEST_CASE("a step longer than the domain is cut to it") {
    each_method([]<class Method> {
        check_steps<Method>(0.0, 0.75, fixed_step(10), 1);
        CHECK(recorder::take().front().h == 0.75);
        check_steps<Method>(0.5, -0.25, fixed_step(10), 1);
        CHECK(recorder::take().front().h == -0.75);
    });
}

TEST_CASE("t ends at t_end, bit for bit") {
    each_method([]<class Method> {
        ensemble<problems::oscillator> e(101);
        e.state(0) = 1.0;
        e.state(1) = 0.0;
        for (std::int64_t i = 0; i < e.size(); ++i) {
            e.t_begin()[i] = std::sin(static_cast<double>(i)) * 3;
            e.t_end()[i] = std::cos(static_cast<double>(i)) * 10;  // before t_begin in half of them
        }
        solve<Method>(tests::test_device(1), e, with_tolerance(1e-8));
        for (std::int64_t i = 0; i < e.size(); ++i) {
            CHECK(e.status(i) == status::success);
            CHECK(compare::same_bits(e.t()[i], e.t_end()[i]));
        }
    });
}
TEST_CASE("t ends at t_end, bit for bit, in single precision") {
    each_method([]<class Method> {
        ensemble<problems::oscillator, float> e(101);
        e.state(0) = 1.0f;
        e.state(1) = 0.0f;
        for (std::int64_t i = 0; i < e.size(); ++i) {
            e.t_begin()[i] = std::sin(static_cast<float>(i)) * 3;
            e.t_end()[i] = std::cos(static_cast<float>(i)) * 10;
        }
        solve<Method>(tests::test_device(1), e, with_tolerance(1e-4));
        for (std::int64_t i = 0; i < e.size(); ++i) {
            CHECK(e.status(i) == status::success);
            CHECK(compare::same_bits(e.t()[i], e.t_end()[i]));
        }
    });
}
TEST_CASE("the last step ends at t_end where after_step sees it") {
    each_method([]<class Method> {
        run<Method>(0.1, 1.7, with_tolerance(1e-6, 0.3));
        CHECK(recorder::take().back().t == 1.7);
    });
}
TEST_CASE("fixed steps end at multiples of the step, without accumulated rounding") {
    run<runge_kutta_4>(0.0, 10.0, fixed_step(1e-3));
    const auto steps = recorder::take();
    REQUIRE(steps.size() == 10000);
    for (std::size_t i = 0; i + 1 < steps.size(); ++i)
        if (steps[i].t != static_cast<double>(i + 1) * 1e-3) FAIL("step " << i << " ends at " << steps[i].t);
}

TEST_CASE("an integration back to its start returns to where it began") {
    each_method([]<class Method> {
        ensemble<problems::log_circle> e(8);
        for (std::int64_t i = 0; i < e.size(); ++i) {
            const auto start = problems::log_circle::exact(0.25 * static_cast<double>(i));
            e.state(0)[i] = start[0];
            e.state(1)[i] = start[1];
        }
        const Eigen::ArrayXd u = e.state(0), w = e.state(1);
        e.time_domain(0, 3);
        const auto there = solve<Method>(tests::test_device(1), e, with_tolerance(1e-9));
        CHECK((e.state(0) - u).abs().maxCoeff() > 0.5);
        e.time_domain(3, 0);
        e.restart();
        const auto back = solve<Method>(tests::test_device(1), e, with_tolerance(1e-9));
        // Every step adds an error below the tolerance of 1e-9 times |y| <= e. The flow along the circle magnifies it
        // at most by the ratio of the coordinates, e^2. RK4 with h = 1/64: error per step h^5 / 120 times derivatives
        // of ten.
        const double steps = static_cast<double>(there.accepted_steps + back.accepted_steps) / 8;
        const double bound = std::exp(2.0) * steps * std::exp(1.0) * 1e-9;
        CHECK((e.state(0) - u).abs().maxCoeff() < bound);
        CHECK((e.state(1) - w).abs().maxCoeff() < bound);
        CHECK((e.t() == 0).all());
    });
}
TEST_CASE("an integration backwards follows the solution backwards") {
    each_method([]<class Method> {
        ensemble<problems::timed_circle> e(1);
        const auto start = problems::timed_circle::exact(2.0), end = problems::timed_circle::exact(0.5);
        e.state(0) = start[0];
        e.state(1) = start[1];
        e.time_domain(2, 0.5);
        const auto r = solve<Method>(tests::test_device(1), e, with_tolerance(1e-9, 1.0 / 256));
        const double bound = std::exp(2.0) * static_cast<double>(r.accepted_steps) * std::exp(1.0) * 1e-9;
        CHECK(std::abs(e.state(0)[0] - end[0]) < bound);
        CHECK(std::abs(e.state(1)[0] - end[1]) < bound);
    });
}
TEST_CASE("steps and their announced successors are negative backwards") {
    each_method([]<class Method> {
        run<Method>(1.0, -2.0, with_tolerance(1e-6, 0.25));
        double t = 1;
        for (const auto& step : recorder::take()) {
            CHECK(step.h < 0);
            CHECK(step.t < t);
            if (Method::embedded_order > 0) CHECK(step.h_next < 0);
            t = step.t;
        }
    });
}

TEST_CASE("an empty domain is a success without a step that leaves the state alone") {
    each_method([]<class Method> {
        ensemble<problems::oscillator> e(3);
        e.state(0) = 0.1;
        e.state(1) = -0.7;
        e.t_begin() = 2.5;
        e.t_end() = 2.5;
        const auto r = solve<Method>(tests::test_device(1), e, with_tolerance(1e-6));
        CHECK(r.count(status::success) == 3);
        CHECK(r.accepted_steps + r.rejected_steps + r.rhs_evaluations == 0);
        CHECK((e.state(0) == 0.1).all());
        CHECK((e.state(1) == -0.7).all());
        CHECK((e.t() == 2.5).all());
        CHECK((e.phases_done() == 1).all());
    });
}
TEST_CASE("empty domains among others disturb none") {
    each_method([]<class Method> {
        ensemble<problems::oscillator> mixed(50), full(50);
        for (auto* e : {&mixed, &full}) {
            e->state(0) = Eigen::ArrayXd::LinSpaced(50, 1.0, 2.0);
            e->state(1) = 0.0;
            e->time_domain(0, 3);
        }
        for (std::int64_t i = 0; i < 50; i += 3) mixed.t_end()[i] = 0;
        solve<Method>(tests::test_device(1), mixed, with_tolerance(1e-8));
        solve<Method>(tests::test_device(1), full, with_tolerance(1e-8));
        for (std::int64_t i = 0; i < 50; ++i)
            if (i % 3 != 0) CHECK(compare::difference(mixed, i, full, i) == "");
    });
}
TEST_CASE("an empty domain calls initialise and finalise once in every phase") {
    each_method([]<class Method> {
        ensemble<hooked::stopper> e(2);
        e.state(0) = 0.0;
        e.parameter(hooked::stopper::phase_stop) = 1e9;
        e.parameter(hooked::stopper::instance_stop) = 1e9;
        e.time_domain(1, 1);
        options o = with_tolerance(1e-6);
        o.phases = 3;
        solve<Method>(tests::test_device(1), e, o);
        CHECK((e.integer_accessory(hooked::stopper::begun) == 3).all());
        CHECK((e.integer_accessory(hooked::stopper::finished) == 3).all());
        CHECK((e.phases_done() == 3).all());
    });
}

TEST_CASE("an endless domain goes on until a hook ends the phase") {
    each_method([]<class Method> {
        for (const double sign : {1.0, -1.0}) {
            ensemble<hooked::stopper> e(1);
            e.state(0) = 0.0;
            // backwards t falls: the end of the instance, as y >= 0 from the first step on, stops it
            e.parameter(hooked::stopper::phase_stop) = sign > 0 ? 20.0 : 1e9;
            e.parameter(hooked::stopper::instance_stop) = sign > 0 ? 1e9 : -1e9;
            e.time_domain(0, sign * std::numeric_limits<double>::infinity());
            const auto r = solve<Method>(tests::test_device(1), e, with_tolerance(1e-6, 0.125));
            CHECK(r.count(status::stopped_by_user) == 1);
            CHECK(std::abs(e.state(0)[0] - e.t()[0]) <= 1e-12 * std::abs(e.t()[0]));  // y' = 1: roundings only
            CHECK(sign * e.t()[0] > 0);
            if (sign > 0) CHECK(e.t()[0] >= 20);
        }
    });
}
