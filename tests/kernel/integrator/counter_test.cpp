// SPDX-License-Identifier: MIT
// The library's counters against the models' own counts.
#include <cmath>
#include <cstdint>
#include <limits>

#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/counted.hpp"
#include "tests/support/device.hpp"

namespace {

using compare::each_adaptive_method;
using compare::each_method;
using compare::fixed_step;
using compare::with_tolerance;
using myriad::device;
using myriad::ensemble;
using myriad::options;
using myriad::solve;
using myriad::status;

template <class Model>
ensemble<Model> oscillators(std::int64_t size = 9) {
    ensemble<Model> e(size);
    e.state(0) =
        Eigen::ArrayXd::LinSpaced(size, 1.0, 30.0);  // tolerances are absolute for some and relative for others
    e.state(1) = 0.0;
    e.time_domain(0, 20);
    return e;
}

/// Runs phases of oscillators; compares evaluations and returns the report.
template <class Model, class Method>
auto count(options o, int threads = 1) {
    auto e = oscillators<Model>();
    o.advice = myriad::advice::off;
    counted::take();
    auto r = solve<Method>(tests::test_device(threads), e, o);
    const std::int64_t evaluations = counted::take();
    CHECK(r.rhs_evaluations == evaluations);
    CHECK(e.rhs_evaluations().sum() == evaluations);
    CHECK(e.accepted_steps().sum() == r.accepted_steps);
    CHECK(e.rejected_steps().sum() == r.rejected_steps);
    CHECK(e.located_steps().sum() == r.located_steps);
    if (tests::tests_cpu()) {  // scalar lanes have no idle neighbours: every iteration is some instance's trial
        CHECK(r.lanes == 1);
        CHECK(r.lane_turns == r.accepted_steps + r.rejected_steps + r.located_steps);
    }
    CHECK(r.failed() == 0);
    return r;
}

/// A first step far too long, so that trials are rejected.
options rough_start() {
    options o = with_tolerance(1e-9);
    o.step = 10;
    o.advice = myriad::advice::off;  // its evaluations are not part of the integration
    return o;
}

}  // namespace

TEST_CASE("runge_kutta_4 evaluates the right-hand side four times a step") {
    const auto r = count<counted::oscillator, myriad::runge_kutta_4>(fixed_step(0.0625));
    CHECK(r.accepted_steps == 9 * 320);
    CHECK(r.rejected_steps == 0);
    CHECK(r.rhs_evaluations == 4 * r.accepted_steps);
}
TEST_CASE("cash_karp evaluates the right-hand side six times a trial, a repeated one too") {
    const auto r = count<counted::oscillator, myriad::cash_karp>(rough_start());
    CHECK(r.rejected_steps >= 9);
    CHECK(r.rhs_evaluations == 6 * (r.accepted_steps + r.rejected_steps));
}
TEST_CASE("tsitouras_5 evaluates the right-hand side six times a trial and once where a phase begins") {
    options o = rough_start();
    o.phases = 3;
    const auto r = count<counted::oscillator, myriad::tsitouras_5>(o);
    CHECK(r.rejected_steps >= 9);
    CHECK(r.rhs_evaluations == 6 * (r.accepted_steps + r.rejected_steps) + 9 * 3);
}
TEST_CASE("evaluations are counted as the model counts them, in phases and on two threads") {
    each_method([]<class Method> {
        for (const int threads : {1, 2}) {
            options o = with_tolerance(1e-9);
            o.phases = 4;
            o.phase_step = myriad::phase_step::carry_on;
            count<counted::oscillator, Method>(o, threads);
        }
    });
}
TEST_CASE("evaluations are counted as the model counts them where events are located") {
    each_method([]<class Method> {
        options o = with_tolerance(1e-9, 0.25);
        o.events.resize(2);
        for (auto& event : o.events) event.tolerance = 1e-10;
        o.phases = 2;
        const auto r = count<counted::with_events, Method>(o);
        CHECK(r.located_steps > 9 * 20);  // some six of each event in [0, 20], each redone at least once
    });
}
TEST_CASE("evaluations are counted as the model counts them where points inside the steps are looked at") {
    each_method([]<class Method> {
        options o = with_tolerance(1e-9, 0.25);
        o.sub_samples = 4;
        count<counted::with_events, Method>(o);
    });
}
TEST_CASE("evaluations are counted as the model counts them where events change the state") {
    each_method([]<class Method> {
        options o = with_tolerance(1e-9, 0.25);
        o.events.resize(1);
        o.events[0].direction = myriad::direction::falling;
        const auto r = count<counted::bouncing, Method>(o);
        CHECK(r.located_steps > 9 * 5);
    });
}
TEST_CASE("steps without event, and those redone for one, are counted apart") {
    each_adaptive_method([]<class Method> {
        // events that do not affect the right-hand side: as many accepted steps as after_step would see
        options o = with_tolerance(1e-9);
        auto plain = oscillators<counted::oscillator>(1);
        auto watched = oscillators<counted::with_events>(1);
        solve<Method>(tests::test_device(1), plain, o);
        solve<Method>(tests::test_device(1), watched, o);
        CHECK(plain.located_steps()[0] == 0);
        CHECK(watched.located_steps()[0] > 0);
        // each of the 12 events splits at most one step in two
        CHECK(watched.accepted_steps()[0] <= plain.accepted_steps()[0] + 2 * 12);
    });
}
TEST_CASE("a hook that changes nothing costs tsitouras_5 no evaluation") {
    const auto plain = count<counted::oscillator, myriad::tsitouras_5>(rough_start());
    const auto idle = count<counted::idle_hook, myriad::tsitouras_5>(rough_start());
    CHECK(idle.accepted_steps == plain.accepted_steps);
    CHECK(idle.rhs_evaluations == plain.rhs_evaluations);
}
TEST_CASE(
    "a hook that changes an accessory costs tsitouras_5 one evaluation a step, since the slope may depend on it") {
    auto e = oscillators<counted::busy_hook>();
    e.accessory(0) = 0.0;
    counted::take();
    const auto r = solve<myriad::tsitouras_5>(tests::test_device(1), e, rough_start());
    CHECK(r.rhs_evaluations == counted::take());
    // the last step's successor needs no slope
    CHECK(r.rhs_evaluations == 6 * (r.accepted_steps + r.rejected_steps) + r.accepted_steps);
    CHECK((e.accessory(0) == e.accepted_steps().cast<double>()).all());
}
TEST_CASE("nothing is counted where counting is off") {
    auto e = oscillators<counted::oscillator>();
    options o = with_tolerance(1e-9);
    o.counting = myriad::counting::off;
    const auto r = solve<myriad::cash_karp>(tests::test_device(1), e, o);
    CHECK(r.accepted_steps + r.rejected_steps + r.located_steps + r.rhs_evaluations == 0);
    CHECK_FALSE(e.counted());
    CHECK_THROWS_AS(e.accepted_steps(), myriad::error);
}
