// SPDX-License-Identifier: MIT
// How instances fail, and that a failure affects only its own instance: values that are not finite, steps that vanish,
// too many steps.
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/device.hpp"
#include "tests/support/faulty.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/recorder.hpp"

namespace {

using compare::each_adaptive_method;
using compare::each_method;
using compare::fixed_step;
using compare::with_tolerance;
using faulty::clock_fault;
using myriad::device;
using myriad::ensemble;
using myriad::options;
using myriad::runge_kutta_4;
using myriad::solve;
using myriad::status;

constexpr double never = 1e30;

template <class R = double>
ensemble<clock_fault, R> healthy(std::int64_t size, R t_end) {
    ensemble<clock_fault, R> e(size);
    e.state(0) = R(1);
    e.state(1) = R(0.5);
    for (std::int64_t i = 0; i < size; ++i)
        e.parameter(clock_fault::rate)[i] = R(0.5) + R(0.125) * static_cast<R>(i % 13);
    e.parameter(clock_fault::last_good) = static_cast<R>(never);
    e.parameter(clock_fault::kind) = R(0);
    e.time_domain(0, t_end);
    return e;
}

/// Runs 67 instances, some of which fail at different times, on one and two threads, and again without the failures.
template <class Method, class R>
void check_neighbours(const options& o) {
    constexpr std::int64_t size = 67;
    auto good = healthy<R>(size, R(4));
    solve<Method>(tests::test_device(1), good, o);
    for (const int threads : {1, 2}) {
        auto mixed = healthy<R>(size, R(4));
        std::int64_t failing = 0;
        for (std::int64_t i = 0; i < size; ++i) {
            if (i % 5 != 1 && i != 0 && i != 66) continue;
            mixed.parameter(clock_fault::last_good)[i] =
                R(-1) + R(0.3125) * static_cast<R>(i % 14);  // some from the start
            mixed.parameter(clock_fault::kind)[i] = static_cast<R>(i % 2);
            ++failing;
        }
        const auto report = solve<Method>(tests::test_device(threads), mixed, o);
        CHECK(report.count(status::not_finite) == failing);
        CHECK(report.count(status::success) == size - failing);
        CHECK(report.first_failed == 0);
        for (std::int64_t i = 0; i < size; ++i) {
            CAPTURE(i, threads);
            if (mixed.parameter(clock_fault::last_good)[i] == static_cast<R>(never)) {
                CHECK(compare::difference(mixed, i, good, i) == "");
            } else {
                CHECK(std::isfinite(mixed.state(0)[i]));
                CHECK(std::isfinite(mixed.state(1)[i]));
                // In single precision t is compensated, and the stage at the end of a step may be an ulp before it.
                const R ulp = std::is_same_v<R, float> ? std::numeric_limits<R>::epsilon() : R(0);
                CHECK(mixed.t()[i] <= std::max(R(0), mixed.parameter(clock_fault::last_good)[i] * (1 + ulp)));
            }
        }
    }
}

/// y' = 1 from 0, and NaN beyond 1, which the slope of a NaN state does not pass on.
template <class Method, class R = double>
void check_open_cliff() {
    for (const double t_end : {1.25, 2.0, 3.0, 17.0, 1e6}) {
        for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
            CAPTURE(t_end, tolerance);
            ensemble<faulty::open_cliff, R> e(1);
            e.state(0) = R(0);
            e.time_domain(0, static_cast<R>(t_end));
            solve<Method>(tests::test_device(1), e, with_tolerance(tolerance));
            CHECK(e.status(0) == status::not_finite);
            // up to the rounding of the stage at the end of the step, and of a few hundred steps before it
            const R rounding = 4 * std::numeric_limits<R>::epsilon();
            CHECK(e.state(0)[0] <= 1 + rounding);
            CHECK(e.state(0)[0] >= 1 - 1000 * rounding);
        }
    }
}

}  // namespace

// Not finite ----------------------------------------------------------------------------------------------------------

TEST_CASE(
    "with fixed steps, a right-hand side that turns NaN or infinite ends the instance with the last finite state") {
    each_method([]<class Method> {
        for (const double kind : {0.0, 1.0}) {
            auto bad = healthy(1, 4.0), until = healthy(1, 1.0);
            bad.parameter(clock_fault::last_good) = 1.0;
            bad.parameter(clock_fault::kind) = kind;
            // adaptive methods must not shrink this step, which is the minimum
            solve<Method>(tests::test_device(1), bad, fixed_step(0.125));
            solve<Method>(tests::test_device(1), until, fixed_step(0.125));
            CHECK(bad.status(0) == status::not_finite);
            CHECK(bad.t()[0] == 1.0);
            CHECK(bad.accepted_steps()[0] == 8);
            CHECK(bad.rejected_steps()[0] == (Method::embedded_order > 0 ? 1 : 0));
            CHECK(bad.rhs_evaluations()[0] > until.rhs_evaluations()[0]);
            CHECK(compare::same_bits(bad.state(0)[0], until.state(0)[0]));
            CHECK(compare::same_bits(bad.state(1)[0], until.state(1)[0]));
        }
    });
}
TEST_CASE("with fixed steps, single precision fails as double precision does") {
    each_method([]<class Method> {
        auto bad = healthy<float>(1, 4.0f), until = healthy<float>(1, 1.0f);
        bad.parameter(clock_fault::last_good) = 1.0f;
        solve<Method>(tests::test_device(1), bad, fixed_step(0.125));
        solve<Method>(tests::test_device(1), until, fixed_step(0.125));
        CHECK(bad.status(0) == status::not_finite);
        CHECK(bad.t()[0] == 1.0f);
        CHECK(compare::same_bits(bad.state(0)[0], until.state(0)[0]));
    });
}
TEST_CASE("with step-size control, a right-hand side that turns NaN or infinite is approached and ends the instance") {
    each_adaptive_method([]<class Method> {
        for (const double kind : {0.0, 1.0}) {
            auto bad = healthy(1, 4.0);
            bad.parameter(clock_fault::last_good) = 1.0;
            bad.parameter(clock_fault::kind) = kind;
            solve<Method>(tests::test_device(1), bad, with_tolerance(1e-9));
            CAPTURE(kind);
            CHECK(bad.status(0) == status::not_finite);
            // the step shrinks to the resolution of t
            CHECK(bad.t()[0] <= 1.0);
            CHECK(bad.t()[0] >= 1.0 - 1e-12);
            // rate 0.5: y0 = exp(-t/2), y1 = 1/2 + 2 (1 - y0); a tolerance's error in each step
            const double bound = static_cast<double>(bad.accepted_steps()[0]) * 1e-9 * 2;
            CHECK(std::abs(bad.state(0)[0] - std::exp(-0.5)) < bound);
            CHECK(std::abs(bad.state(1)[0] - (2.5 - 2 * std::exp(-0.5))) < bound);
        }
    });
}
TEST_CASE("with step-size control, a state that overflows is not accepted, although its error is none") {
    const auto check = []<class Method>(std::type_identity<Method>) {
        ensemble<recorder::recorded<problems::uniform>> e(1);  // y' = 1
        const double start = 1.7e308;
        e.state(0) = start;
        e.time_domain(1e308, 1.79e308);  // as coarse as the state
        recorder::take();
        solve<Method>(tests::test_device(1), e, with_tolerance(1e-6, 1e306));
        CHECK(e.status(0) == status::not_finite);
        CHECK(e.accepted_steps()[0] > 0);
        // up to the last step that t can resolve
        CHECK(e.state(0)[0] <= std::numeric_limits<double>::max());
        CHECK(e.state(0)[0] >= (1 - 1e-12) * std::numeric_limits<double>::max());
        recorder::take();
    };
    check(std::type_identity<myriad::cash_karp>{});
    check(std::type_identity<myriad::tsitouras_5>{});
}
TEST_CASE("with a minimum step, a right-hand side that turns NaN ends the instance within that step") {
    each_adaptive_method([]<class Method> {
        auto bad = healthy(1, 4.0);
        bad.parameter(clock_fault::last_good) = 1.0;
        options o = with_tolerance(1e-6);
        o.minimum_step = 1e-3;
        solve<Method>(tests::test_device(1), bad, o);
        CHECK(bad.status(0) == status::not_finite);
        CHECK(bad.t()[0] <= 1.0);
        CHECK(bad.t()[0] >= 1.0 - 1e-3);
    });
}
TEST_CASE("a right-hand side that depends on the state alone and leaves its domain ends the instance inside it") {
    each_method([]<class Method> {
        ensemble<faulty::domain_fault> e(1);
        e.state(0) = 0.0;
        e.parameter(0) = 1.0;  // y' = 1 while y <= 1
        e.time_domain(0, 4);
        solve<Method>(tests::test_device(1), e, with_tolerance(1e-9, 0.125));
        CHECK(e.status(0) == status::not_finite);
        CHECK(e.state(0)[0] <= 1.0);
        CHECK(e.state(0)[0] >= 1.0 - 1e-12);  // RK4: at the end of the eighth step exactly
    });
}
TEST_CASE("a right-hand side without a value beyond the state is not crept up to by steps that change nothing") {
    // Where t is finer than y, at the limit, a step that does not change y succeeds, and the next, longer one fails.
    each_adaptive_method([]<class Method> {
        for (const double speed : {1.0, -1.0}) {
            for (const double t_begin : {0.0, -0.5, -1.0, 0.99, 10.0}) {
                for (const double start : {0.0, 0.5, 0.999}) {
                    for (const double length : {4.0, -4.0}) {
                        CAPTURE(speed, t_begin, start, length);
                        ensemble<faulty::cliff> e(1);
                        const double side = length > 0 ? speed : -speed;
                        e.state(0) = side * start;
                        e.parameter(faulty::cliff::limit) = side;
                        e.parameter(faulty::cliff::speed) = speed;
                        e.parameter(faulty::cliff::side) = side;
                        e.time_domain(t_begin, t_begin + length);
                        options o = with_tolerance(1e-9);
                        o.max_steps = 1'000'000;
                        solve<Method>(tests::test_device(1), e, o);
                        CHECK(e.status(0) == status::not_finite);
                        CHECK(std::abs(e.state(0)[0]) <= 1.0);
                        CHECK(std::abs(e.state(0)[0]) >= 1.0 - 1e-12);
                        CHECK(e.rejected_steps()[0] <= 2000);
                    }
                }
            }
        }
    });
}
TEMPLATE_TEST_CASE(
    "a slope that is NaN in a stage without weight is seen where the model makes a number of a NaN state", "",
    myriad::cash_karp, myriad::tsitouras_5, myriad::dormand_prince_5, myriad::verner_7, myriad::verner_9,
    myriad::dormand_prince_8, myriad::rosenbrock_23, myriad::rodas_5p) {
    check_open_cliff<TestType>();
}
TEMPLATE_TEST_CASE("a slope that is NaN in a stage without weight is seen in single precision, too", "",
                   myriad::cash_karp, myriad::dormand_prince_8) {
    check_open_cliff<TestType, float>();
}
TEST_CASE("with fixed steps, a slope that is NaN in a stage without weight ends the instance before that step") {
    ensemble<faulty::open_cliff> e(1);
    e.state(0) = 0.0;
    e.time_domain(0, 3);
    solve<faulty::midpoint_rule>(tests::test_device(1), e, fixed_step(0.375));
    CHECK(e.status(0) == status::not_finite);
    // the middle of the third step, at 0.9375, is within the domain, its end is not
    CHECK(e.t()[0] == 1.125);
    CHECK(e.state(0)[0] == 1.125);
}
TEST_CASE("a solution that runs along the border of its domain is not ended for the steps that leave it") {
    each_adaptive_method([]<class Method> {
        for (const double t_end : {3000.0, 1e300, std::numeric_limits<double>::infinity()}) {
            CAPTURE(t_end);
            ensemble<faulty::guarded> e(1);
            e.state(0) = 0.0;
            e.state(1) = 1.0;
            e.parameter(faulty::guarded::limit) = 1.00005;
            e.parameter(faulty::guarded::stop) = 2999.0;
            e.time_domain(0, t_end);
            solve<Method>(tests::test_device(1), e, with_tolerance(1e-6));
            CHECK(e.status(0) == status::stopped_by_user);
            CHECK(e.t()[0] >= 2999);
            CHECK(e.rejected_steps()[0] > 2048);
        }
    });
}
TEST_CASE("an instance that is not finite from the start keeps its state") {
    each_method([]<class Method> {
        auto bad = healthy(1, 4.0);
        bad.parameter(clock_fault::last_good) = -1.0;
        solve<Method>(tests::test_device(1), bad, with_tolerance(1e-6));
        CHECK(bad.status(0) == status::not_finite);
        CHECK(bad.t()[0] == 0.0);
        CHECK(bad.state(0)[0] == 1.0);
        CHECK(bad.state(1)[0] == 0.5);
        CHECK(bad.accepted_steps()[0] == 0);
    });
}
TEST_CASE("instances that fail leave the others untouched, bit for bit") {
    each_method([]<class Method> {
        check_neighbours<Method, double>(with_tolerance(1e-8, 1.0 / 32));
        check_neighbours<Method, double>(fixed_step(1.0 / 16));
    });
}
TEST_CASE("instances that fail leave the others untouched, bit for bit, in single precision") {
    each_method([]<class Method> {
        check_neighbours<Method, float>(with_tolerance(1e-4, 1.0 / 32));
        check_neighbours<Method, float>(fixed_step(1.0 / 16));
    });
}
TEST_CASE("a failed instance takes no part in further calls, until the ensemble is restarted") {
    each_method([]<class Method> {
        auto e = healthy(2, 4.0), copy = healthy(2, 4.0);
        for (auto* x : {&e, &copy}) {
            x->parameter(clock_fault::last_good)[0] = 1.0;
            solve<Method>(tests::test_device(1), *x, fixed_step(0.125));
        }
        solve<Method>(tests::test_device(1), e, fixed_step(0.125));
        CHECK(compare::difference(e, 0, copy, 0) == "");
        CHECK(e.phases_done()[0] == 0);
        CHECK(e.phases_done()[1] == 2);
        e.restart();
        e.parameter(clock_fault::last_good)[0] = never;
        solve<Method>(tests::test_device(1), e, fixed_step(0.125));
        CHECK(e.status(0) == status::success);
    });
}
TEST_CASE("with step-size control, a finite trial after one that was not is judged by its error alone") {
    // NaN for t > 1 costs one rejection if the domain ends at 1 and the first step goes beyond: it must leave no trace.
    each_adaptive_method([]<class Method> {
        auto e = healthy(1, 1.0);
        e.parameter(clock_fault::last_good) = 1.0;
        options o = with_tolerance(1e-6);
        solve<Method>(tests::test_device(1), e, o);
        CHECK(e.status(0) == status::success);
        CHECK(e.t()[0] == 1.0);
    });
}

TEST_CASE("an after_step that writes NaN ends the instance with the state before it") {
    each_method([]<class Method> {
        ensemble<faulty::hook_fault> e(1);
        e.state(0) = 0.0;
        e.parameter(0) = 0.5;
        e.integer_accessory(faulty::hook_fault::which) = faulty::hook_fault::in_after_step;
        e.integer_accessory(faulty::hook_fault::finished) = 0;
        e.time_domain(0, 1);
        solve<Method>(tests::test_device(1), e, fixed_step(0.125));
        CHECK(e.status(0) == status::not_finite);
        CHECK(e.t()[0] == 0.5);
        CHECK(std::abs(e.state(0)[0] - 0.5) <= 1e-15);  // four steps of y' = 1
        CHECK(e.integer_accessory(faulty::hook_fault::finished)[0] == 0);
    });
}
TEST_CASE("an initialise that writes NaN ends the instance with the state before it") {
    each_method([]<class Method> {
        ensemble<faulty::hook_fault> e(1);
        e.state(0) = 0.25;
        e.parameter(0) = 0.0;
        e.integer_accessory(faulty::hook_fault::which) = faulty::hook_fault::in_initialise;
        e.time_domain(0, 1);
        solve<Method>(tests::test_device(1), e, fixed_step(0.125));
        CHECK(e.status(0) == status::not_finite);
        CHECK(e.t()[0] == 0.0);
        CHECK(e.state(0)[0] == 0.25);
    });
}
TEST_CASE("a finalise that writes NaN ends the instance with the state before it") {
    each_method([]<class Method> {
        ensemble<faulty::hook_fault> e(1);
        e.state(0) = 0.25;
        e.parameter(0) = 0.0;
        e.integer_accessory(faulty::hook_fault::which) = faulty::hook_fault::in_finalise;
        e.time_domain(0, 1);
        solve<Method>(tests::test_device(1), e, fixed_step(0.125));
        CHECK(e.status(0) == status::not_finite);
        CHECK(std::abs(e.state(0)[0] - 1.25) <= 1e-15);  // eight steps of y' = 1
    });
}

// Vanishing steps
// -------------------------------------------------------------------------------------------------------

TEST_CASE("with step-size control, a solution that blows up ends as step_underflow at its pole") {
    each_adaptive_method([]<class Method> {
        for (const double sign : {1.0, -1.0}) {  // y' = y^2 is its own mirror image
            ensemble<faulty::blow_up> e(1);
            e.state(0) = sign;
            e.time_domain(0, 2 * sign);
            solve<Method>(tests::test_device(1), e, with_tolerance(1e-9));
            CHECK(e.status(0) == status::step_underflow);
            // The pole of the numerical solution: each step's relative error of 1e-9 shifts it by 1e-9 of the remaining
            // time.
            CHECK(std::abs(sign * e.t()[0] - 1) < 1e-8);
            CHECK(std::isfinite(e.state(0)[0]));
            CHECK(sign * e.state(0)[0] > 1e7);
        }
    });
}
TEST_CASE("with step-size control, a solution that blows up ends as step_underflow in single precision") {
    each_adaptive_method([]<class Method> {
        ensemble<faulty::blow_up, float> e(1);
        e.state(0) = 1.0f;
        e.time_domain(0, 2);
        solve<Method>(tests::test_device(1), e, with_tolerance(1e-4));
        CHECK(e.status(0) == status::step_underflow);
        CHECK(std::abs(e.t()[0] - 1) < 1e-3f);
        CHECK(std::isfinite(e.state(0)[0]));
    });
}
TEST_CASE("with fixed steps, a solution that blows up ends as not_finite with a finite state") {
    ensemble<faulty::blow_up> e(1);
    e.state(0) = 1.0;
    e.time_domain(0, 2);
    solve<runge_kutta_4>(tests::test_device(1), e, fixed_step(1.0 / 64));
    CHECK(e.status(0) == status::not_finite);
    CHECK(std::isfinite(e.state(0)[0]));
    CHECK(e.t()[0] < 2.0);
}
TEST_CASE("an error test that fails at the minimum step ends the instance as step_underflow before the pole") {
    each_adaptive_method([]<class Method> {
        ensemble<faulty::blow_up> e(1);
        e.state(0) = 1.0;
        e.time_domain(0, 2);
        options o = with_tolerance(1e-9);
        o.minimum_step = 1e-3;
        solve<Method>(tests::test_device(1), e, o);
        CHECK(e.status(0) == status::step_underflow);
        CHECK(e.t()[0] < 1.0);
        CHECK(e.t()[0] > 0.5);  // h = 1e-3 has an error of 1e-9 only near the pole
        // the state is still on the solution 1 / (1 - t), whose relative error grows as y does
        CHECK(std::abs(e.state(0)[0] * (1 - e.t()[0]) - 1) <
              static_cast<double>(e.accepted_steps()[0]) * 1e-9 / (1 - e.t()[0]));
    });
}
TEST_CASE("a slope that jumps is passed with small steps, or ends the instance where the minimum step forbids them") {
    each_adaptive_method([]<class Method> {
        ensemble<faulty::slope_jump> e(2);
        e.state(0) = 0.0;
        e.parameter(0) = 1.0 / 3;
        e.time_domain(0, 1);
        options o = with_tolerance(1e-9);
        solve<Method>(tests::test_device(1), e, o);
        CHECK(e.status(0) == status::success);
        // Only the step across the jump has an error. The stages on one side of it leave an estimate of h times a sum
        // of some first error weights, at least 0.0017 in magnitude for both methods, so that h < 1e-9 / 0.0017.
        CHECK(std::abs(e.state(0)[0] - 2.0 / 3) < 1e-9 / 0.0017);
        CHECK(e.rejected_steps()[0] > 3);

        ensemble<faulty::slope_jump> f(2);
        f.state(0) = 0.0;
        f.parameter(0) = 1.0 / 3;
        f.time_domain(0, 1);
        o.minimum_step = 1e-2;
        solve<Method>(tests::test_device(1), f, o);
        CHECK(f.status(0) == status::step_underflow);
        CHECK(f.t()[0] <= 1.0 / 3);
        CHECK(f.t()[0] >= 1.0 / 3 - 1e-2);
        CHECK(f.state(0)[0] == 0.0);
    });
}

// Too many steps
// --------------------------------------------------------------------------------------------------------

TEST_CASE("with fixed steps, max_steps ends the instance after just so many steps") {
    each_method([]<class Method> {
        for (const std::int64_t most : {1, 2, 7, 8, 9, 15, 16, 17, 24, 64, 99}) {
            auto e = healthy(1, 100.0 / 16), until = healthy(1, static_cast<double>(most) / 16);
            options o = fixed_step(1.0 / 16);
            solve<Method>(tests::test_device(1), until, o);
            o.max_steps = most;
            solve<Method>(tests::test_device(1), e, o);
            CAPTURE(most);
            CHECK(e.status(0) == status::max_steps);
            CHECK(e.accepted_steps()[0] == most);
            CHECK(e.t()[0] == static_cast<double>(most) / 16);
            CHECK(compare::same_bits(e.state(0)[0], until.state(0)[0]));
        }
    });
}
TEST_CASE("where max_steps ends an instance does not depend on its neighbours") {
    each_method([]<class Method> {
        for (const std::int64_t most : {8, 16, 20, 32}) {
            options o = fixed_step(1.0 / 16);
            o.max_steps = most;
            auto together = healthy(50, 100.0 / 16);
            for (std::int64_t i = 0; i < together.size(); ++i)
                together.t_end()[i] = static_cast<double>(1 + 7 * (i % 6)) / 16;
            solve<Method>(tests::test_device(1), together, o);
            for (std::int64_t i = 0; i < together.size(); ++i) {
                auto alone = healthy(1, together.t_end()[i]);
                alone.parameter(clock_fault::rate) = together.parameter(clock_fault::rate)[i];
                solve<Method>(tests::test_device(1), alone, o);
                CAPTURE(most, i);
                CHECK(compare::difference(together, i, alone, 0) == "");
                CHECK(together.accepted_steps()[i] == std::min<std::int64_t>(most, 1 + 7 * (i % 6)));
            }
        }
    });
}
TEST_CASE("as many steps as max_steps are enough") {
    each_method([]<class Method> {
        for (const std::int64_t steps : {1, 8, 16, 20}) {
            auto e = healthy(1, static_cast<double>(steps) / 16);
            options o = fixed_step(1.0 / 16);
            o.max_steps = steps;
            solve<Method>(tests::test_device(1), e, o);
            CHECK(e.status(0) == status::success);
            CHECK(e.accepted_steps()[0] == steps);
        }
    });
}
TEST_CASE("a forgotten max_steps ends adaptive steps after 200 000, and has no limit for fixed ones") {
    auto adaptive = healthy(1, 1e6), fixed = healthy(1, 250'000.0 / 1024);
    options o;
    o.step = o.maximum_step = 1.0 / 1024;
    const auto report = solve<myriad::cash_karp>(tests::test_device(1), adaptive, o);
    CHECK(adaptive.status(0) == status::max_steps);
    CHECK(adaptive.accepted_steps()[0] + adaptive.rejected_steps()[0] == 200'000);
    CHECK(report.notes.back().text().find("max_steps: 200000 trial steps") == 0);
    solve<runge_kutta_4>(tests::test_device(1), fixed, fixed_step(1.0 / 1024));
    CHECK(fixed.status(0) == status::success);
    CHECK(fixed.accepted_steps()[0] == 250'000);
}
TEST_CASE("with step-size control, max_steps counts rejected trials too") {
    each_adaptive_method([]<class Method> {
        for (const std::int64_t most : {1, 5, 30}) {
            ensemble<faulty::slope_jump> e(1);
            e.state(0) = 0.0;
            e.parameter(0) = 0.1;
            e.time_domain(0, 1000);
            options o = with_tolerance(1e-9);
            o.maximum_step = 0.01;
            o.step = 0.01;
            o.max_steps = most;
            solve<Method>(tests::test_device(1), e, o);
            CHECK(e.status(0) == status::max_steps);
            CHECK(e.accepted_steps()[0] + e.rejected_steps()[0] == most);
            CHECK(e.t()[0] < 1000);
            if (most == 30) CHECK(e.rejected_steps()[0] > 0);
        }
    });
}
TEST_CASE("max_steps counts anew in every phase") {
    each_method([]<class Method> {
        auto e = healthy(3, 1.0);
        options o = fixed_step(1.0 / 16);
        o.max_steps = 16;
        o.phases = 4;
        solve<Method>(tests::test_device(1), e, o);
        CHECK(e.status(0) == status::success);
        CHECK((e.accepted_steps() == 64).all());
    });
}
TEST_CASE("a report names the first instance that failed, with its inputs") {
    auto e = healthy(10, 4.0);
    e.parameter(clock_fault::last_good)[7] = 2.0;
    e.parameter(clock_fault::last_good)[4] = 1.0;
    const auto r = solve<runge_kutta_4>(tests::test_device(1), e, fixed_step(0.125));
    CHECK(r.failed() == 2);
    CHECK(r.first_failed == 4);
    CHECK(r.first_status == status::not_finite);
    CHECK(r.first_t == 1.0);
    CHECK(r.first_t_end == 4.0);
    REQUIRE(r.first_parameter.size() == 3);
    CHECK(r.first_parameter[clock_fault::last_good] == 1.0);
    REQUIRE(r.first_state.size() == 2);
    CHECK(r.first_state[0] == e.state(0)[4]);
}
