// SPDX-License-Identifier: MIT
// The step-size control as users meet it: one trial at a time through `max_steps = 1`, against textbook steps, and
// whole integrations through a log of their steps.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/support/device.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/recorder.hpp"
#include "tests/support/textbook.hpp"

namespace {

using myriad::cash_karp;
using myriad::options;
using myriad::tsitouras_5;
using problems::log_circle;
using problems::oscillator;

// fast_power is accurate to 2e-5; the rounding of the ratio of error to tolerance adds nothing to that.
constexpr double power_error = 2.1e-5;

template <class Model, class R = double>
myriad::ensemble<Model, R> one_instance(double t_begin, double t_end) {
    myriad::ensemble<Model, R> e(1);
    const auto start = Model::exact(t_begin);
    for (int c = 0; c < Model::n_state; ++c) e.state(c) = static_cast<R>(start[c]);
    e.time_domain(static_cast<R>(t_begin), static_cast<R>(t_end));
    return e;
}

struct outcome {
    bool accepted;
    double next_step;
};

/// The first trial of an integration from t = 1/2.
template <class Method>
outcome first_trial(options o) {
    auto e = one_instance<oscillator>(0.5, 100);
    o.max_steps = 1;
    const auto report = myriad::solve<Method>(tests::test_device(1), e, o);
    REQUIRE(report.accepted_steps + report.rejected_steps == 1);
    return {report.accepted_steps == 1, e.next_step()[0]};
}

/// The largest ratio of the error of that trial to its tolerance.
template <class Method>
double error_ratio(const options& o) {
    const auto start = oscillator::exact(0.5);
    const textbook::step<Method, oscillator> step(0.5, o.step, start);
    double worst = 0;
    for (std::size_t c = 0; c < 2; ++c) {
        const double scale =
            std::max(o.absolute_tolerance[c],
                     o.relative_tolerance[c] * std::max(std::abs(start[static_cast<int>(c)]), std::abs(step.y[c])));
        worst = std::max(worst, std::abs(step.estimate[c]) / scale);
    }
    return worst;
}

/// Steps from far too small to far too large, against the elementary controller of the MPGOS package.
template <class Method>
void check_controller(options o) {
    int accepted = 0, rejected = 0, grown = 0, shrunk = 0;
    for (double h = 1.0 / 1024; h < 2; h *= 1.09) {
        o.step = h;
        const double q = error_ratio<Method>(o);
        REQUIRE(std::abs(q - 1) > 1e-6);  // else rounding would decide; false for NaN
        const outcome o1 = first_trial<Method>(o);
        const double factor = 0.9 * std::pow(q, q <= 1 ? -1.0 / 5 : -1.0 / 4);
        const double limited = std::clamp(factor, o.shrink_limit, o.growth_limit);
        CAPTURE(h, q, factor);
        CHECK(o1.accepted == (q < 1));
        CHECK(std::abs(o1.next_step / (h * limited) - 1) <= power_error);
        (o1.accepted ? accepted : rejected) += 1;
        if (factor > o.growth_limit) ++grown;
        if (factor < o.shrink_limit) ++shrunk;
    }
    // the range has covered all four cases
    CHECK(accepted > 5);
    CHECK(rejected > 5);
    CHECK(grown > 5);
    CHECK(shrunk > 0);
}

options tolerance(double relative, double absolute) {
    options o;
    o.relative_tolerance = relative;
    o.absolute_tolerance = absolute;
    return o;
}

/// Steps are rounded to the resolution of t, here below 32.
constexpr double resolution = 16 * std::numeric_limits<double>::epsilon();

/// A step whose error is `q` times the tolerance.
template <class Method>
options with_ratio(double h, double q) {
    options o = tolerance(1e-30, 1);
    o.step = h;
    o.absolute_tolerance = error_ratio<Method>(o) / q;
    return o;
}

template <class Method, class Model>
std::vector<recorder::call> steps_of(const options& o, double t_end, double t_begin = 0) {
    recorder::take();
    auto e = one_instance<recorder::recorded<Model>>(t_begin, t_end);
    const auto report = myriad::solve<Method>(tests::test_device(1), e, o);
    REQUIRE(report.count(myriad::status::success) == 1);
    auto steps = recorder::take();
    REQUIRE(static_cast<std::int64_t>(steps.size()) == report.accepted_steps);
    return steps;
}

}  // namespace

TEST_CASE(
    "cash_karp's next step is 0.9 times the fifth root of tolerance over error, or the fourth after a rejection") {
    check_controller<cash_karp>(tolerance(1e-30, 1e-8));
}
TEST_CASE(
    "tsitouras_5's next step is 0.9 times the fifth root of tolerance over error, or the fourth after a rejection") {
    check_controller<tsitouras_5>(tolerance(1e-30, 1e-8));
}
TEST_CASE("the controller works with a relative tolerance alone") {
    check_controller<cash_karp>(tolerance(1e-8, 1e-30));
    check_controller<tsitouras_5>(tolerance(1e-8, 1e-30));
}
TEST_CASE("the limits of growth and shrinkage are the options'") {
    options o = tolerance(1e-8, 1e-8);
    o.growth_limit = 1.5;
    o.shrink_limit = 0.5;
    check_controller<cash_karp>(o);
    check_controller<tsitouras_5>(o);
}
TEST_CASE("each component of the state is held to its own tolerance") {
    options o;
    o.relative_tolerance = {1e-30, 1e-30};
    o.absolute_tolerance = {1e-5, 1e-8};
    check_controller<cash_karp>(o);
    o.absolute_tolerance = {1e-8, 1e-5};
    check_controller<cash_karp>(o);
}

TEST_CASE("a step that grows without limit by its error grows by exactly the growth limit") {
    options o = with_ratio<cash_karp>(0.01, 1e-9);
    CHECK(std::abs(first_trial<cash_karp>(o).next_step - 0.01 * 5.0) <= 5 * resolution);
    o.growth_limit = 1;
    CHECK(std::abs(first_trial<cash_karp>(o).next_step - 0.01) <= resolution);
}
TEST_CASE("a rejected step shrinks by the shrink limit at most") {
    options o = with_ratio<cash_karp>(0.5, 1e9);
    // limits are stored in single precision, and some factors are rounded there
    const double rounding = 0.5 * static_cast<double>(std::numeric_limits<float>::epsilon());
    CHECK(std::abs(first_trial<cash_karp>(o).next_step / (0.5 * 0.1) - 1) <= rounding);
    o.shrink_limit = 0.25;
    CHECK(first_trial<cash_karp>(o).next_step == 0.5 * 0.25);
}

TEST_CASE("the next step is not below the minimum step after an accepted one") {
    options o = with_ratio<cash_karp>(0.25, 0.9);  // the controller wants 0.92 of it
    CHECK(first_trial<cash_karp>(o).next_step < 0.25);
    o.minimum_step = 0.25;
    const outcome o1 = first_trial<cash_karp>(o);
    CHECK(o1.accepted);
    CHECK(o1.next_step == 0.25);
}
TEST_CASE("the next step is not below the minimum step after a rejected one") {
    options o = with_ratio<cash_karp>(0.25, 1e6);
    o.minimum_step = 0.125;
    const outcome o1 = first_trial<cash_karp>(o);
    CHECK_FALSE(o1.accepted);
    CHECK(o1.next_step == 0.125);
}
TEST_CASE("the next step is not above the maximum step") {
    options o = with_ratio<cash_karp>(0.01, 1e-9);
    o.maximum_step = 0.02;
    CHECK(first_trial<cash_karp>(o).next_step == 0.02);
}
TEST_CASE("the first step is not above the maximum step") {
    options o = tolerance(0.5, 1);
    o.step = 1;
    o.maximum_step = 0.125;
    CHECK(steps_of<cash_karp, log_circle>(o, 10).front().h == 0.125);
    CHECK(steps_of<tsitouras_5, log_circle>(o, 10).front().h == 0.125);
}
TEST_CASE("the first step is not below the minimum step") {
    options o = tolerance(0.5, 1);
    o.step = 1e-6;
    o.minimum_step = o.maximum_step = 0.125;
    CHECK(steps_of<cash_karp, log_circle>(o, 10).front().h == 0.125);
}
TEST_CASE("no step of an integration is above the maximum step") {
    options o = tolerance(1e-3, 1e-3);
    o.maximum_step = 0.07;
    const auto steps = steps_of<tsitouras_5, log_circle>(o, 5);
    // The last may be stretched by a thousandth to end the domain without a sliver.
    for (std::size_t i = 0; i + 1 < steps.size(); ++i) CHECK(steps[i].h <= 0.07 + resolution);
    CHECK(steps.back().h <= 0.07 * 1.001);
    CHECK(steps.size() >= 71);  // 5 / 0.07
}
TEST_CASE("no step of an integration is below the minimum step but the last") {
    options o = tolerance(1e-6, 1e-6);
    o.step = 1;
    const auto open = steps_of<cash_karp, log_circle>(o, 20);
    double shortest = o.step, longest = 0;
    for (std::size_t i = 0; i + 1 < open.size(); ++i) {
        shortest = std::min(shortest, open[i].h);
        longest = std::max(longest, open[i].h);
    }
    REQUIRE(longest > 1.5 * shortest);
    // The safety factor leaves room for steps a tenth longer: the shortest ones can be longer and still pass the error
    // test.
    o.minimum_step = 1.05 * shortest;
    const auto steps = steps_of<cash_karp, log_circle>(o, 20);
    for (std::size_t i = 0; i + 1 < steps.size(); ++i) CHECK(steps[i].h >= o.minimum_step - resolution);
}

TEST_CASE("steps without error grow by the growth limit, one after the other") {
    options o;
    o.step = 1.0 / 1024;
    for (const double growth : {5.0, 2.0, 1.25}) {
        o.growth_limit = growth;
        const auto steps = steps_of<cash_karp, problems::uniform>(o, 10);
        REQUIRE(steps.size() > 5);
        for (std::size_t i = 0; i + 2 < steps.size(); ++i)
            CHECK(std::abs(steps[i + 1].h - steps[i].h * growth) <= resolution);
    }
}
TEST_CASE("an accepted step shortens its successor by no more than the safety factor") {
    for (const auto& s : steps_of<tsitouras_5, log_circle>(tolerance(1e-9, 1e-9), 20))
        CHECK(s.h_next >= 0.9 * (1 - power_error) * s.h);  // error <= tolerance
}
TEST_CASE("the step that follows is the one that was announced, unless it was rejected") {
    const auto steps = steps_of<cash_karp, log_circle>(tolerance(1e-9, 1e-9), 20);
    std::size_t kept = 0;
    for (std::size_t i = 0; i + 2 < steps.size(); ++i) {
        CHECK(steps[i + 1].h <= steps[i].h_next + resolution);
        if (steps[i + 1].h >= steps[i].h_next - resolution) ++kept;
    }
    CHECK(kept * 2 > steps.size());  // and rejections are the exception
}
TEST_CASE("steps backwards are those forwards, mirrored") {
    // y'(t) = f(y) run backwards is y' = -f(y); the oscillator's is its mirror image, so the steps agree bit for bit
    const auto there = steps_of<cash_karp, oscillator>(tolerance(1e-9, 1e-9), 10);
    const auto back = steps_of<cash_karp, oscillator>(tolerance(1e-9, 1e-9), -10);
    REQUIRE(there.size() == back.size());
    for (std::size_t i = 0; i < there.size(); ++i) {
        CHECK(back[i].h == -there[i].h);
        CHECK(back[i].t == -there[i].t);
    }
}
TEST_CASE("a component with a loose tolerance does not hold up the others") {
    options o = tolerance(1e-30, 1e-9);
    auto both = one_instance<problems::two_speeds>(0, 20);
    const auto all = myriad::solve<cash_karp>(tests::test_device(1), both, o);
    o.absolute_tolerance = {1e9, 1e9, 1e-9, 1e-9};
    auto loose = one_instance<problems::two_speeds>(0, 20);
    const auto slow = myriad::solve<cash_karp>(tests::test_device(1), loose, o);
    o.absolute_tolerance = 1e-9;
    auto alone = one_instance<oscillator>(0, 20);
    const auto single = myriad::solve<cash_karp>(tests::test_device(1), alone, o);
    CHECK(all.accepted_steps > 15 * single.accepted_steps);  // twenty times as fast
    CHECK(slow.accepted_steps == single.accepted_steps);
    CHECK(slow.rejected_steps == single.rejected_steps);
    // the same steps, so the same state but for roundings of the step size
    CHECK(std::abs(loose.state(2)[0] - alone.state(0)[0]) <= 1e-12);
}
