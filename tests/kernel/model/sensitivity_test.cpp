// SPDX-License-Identifier: MIT
// Sensitivities are the derivatives of closed forms: of smooth flows, through impacts, stop times and phases, in
// samples, records and accessories; and none is made up where there is none.
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/kernel/model/sensitivity_models.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/device.hpp"

namespace {

using namespace sensitivities;
using compare::same_bits_everywhere;
using compare::with_tolerance;
using Eigen::ArrayXd;
using Eigen::Index;
using numbers = std::vector<long double>;

/// The derivative of a closed form by its argument i, by central differences of fourth order in extended precision:
/// with d = 1e-3 their error is about d^4 = 1e-12 of the size.
double derivative(const std::function<long double(const numbers&)>& f, const numbers& at, std::size_t i) {
    const long double d = 1e-3L;
    const auto moved = [&](long double by) {
        numbers x = at;
        x[i] += by;
        return f(x);
    };
    return static_cast<double>((8 * (moved(d) - moved(-d)) - (moved(2 * d) - moved(-2 * d))) / (12 * d));
}

/// Equal to 1e-7 of the size, the aim at tolerances of 1e-10.
auto near(double expected) { return Catch::Matchers::WithinAbs(expected, 1e-7 * (1e-2 + std::abs(expected))); }

/// A ball's height, speed, time of and speed at the last impact, at time t, of r, floor, g, x and v.
struct flight {
    long double x, v, t_impact = 0, speed = 0;
    int bounces = 0;
};
flight fly(const numbers& p, long double until, int most = 1000) {
    flight b{p[3], p[4]};
    for (long double t = 0;;) {
        const long double g = p[2], drop = b.x - p[1];
        const long double down = std::sqrt(b.v * b.v + 2 * g * drop), later = (b.v + down) / g;
        if (t + later > until) {
            const long double rest = until - t;
            b.x += b.v * rest - g * rest * rest / 2;
            b.v -= g * rest;
            return b;
        }
        t += later;
        b = {p[1], p[0] * down, t, down, b.bounces + 1};
        if (b.bounces == most) return b;
    }
}

const numbers thrown = {0.8L, 0.1L, 1.0L, 1.0L, 0.3L};

template <class E>
void throw_ball(E& e, int last) {
    e.parameter(ball::r) = 0.8;
    e.parameter(ball::floor) = 0.1;
    e.shared(ball::g) = 1;
    e.shared_integer(ball::last) = last;
    e.state(ball::x) = 1;
    e.state(ball::v) = 0.3;
    myriad::initial_sensitivities(e);
}

const myriad::options falling = [] {
    myriad::options o = with_tolerance(1e-10);
    o.events = {{.direction = myriad::direction::falling}};
    return o;
}();

}  // namespace

TEST_CASE("sensitivities of a linear flow are the derivatives of its closed form, at the end and at samples") {
    using W = decay_by_all;
    myriad::ensemble<W> e(5);
    e.parameter(decay::k).setLinSpaced(0.5, 1.5);
    e.parameter(decay::unused) = 7;
    e.shared(decay::B) = 0.4;
    e.shared(decay::other) = 3;
    e.state(decay::x) = 2;
    e.state(decay::w) = 0;
    myriad::initial_sensitivities(e);
    e.time_domain(0, 3);
    myriad::options o = with_tolerance(1e-10);
    std::vector<int> all;
    for (int c = 0; c < W::n_state; ++c) all.push_back(c);
    o.samples = {.states = all, .capacity = 3, .times = {0.5, 1.5, 3.0}};
    const auto report = myriad::solve<myriad::dense<myriad::tsitouras_5>>(tests::test_device(), e, o);
    REQUIRE(report.count(myriad::status::success) == e.size());
    for (Index i = 0; i < e.size(); ++i) {
        for (const int sample : {0, 1, 2, 3}) {  // the last stands for the end
            const long double t = sample == 0 ? 0.5L : sample == 1 ? 1.5L : 3.0L;
            const numbers at = {static_cast<long double>(e.parameter(decay::k)[i]), 2, 0.4L};
            const auto x = [&](const numbers& p) { return p[2] / p[0] + (p[1] - p[2] / p[0]) * std::exp(-p[0] * t); };
            for (int d = 0; d < 3; ++d) {
                const int c = W::sensitivity(decay::x, d);
                CAPTURE(i, sample, d);
                CHECK_THAT(sample == 3 ? e.state(c)[i] : e.samples().state(c)(i, sample),
                           near(derivative(x, at, static_cast<std::size_t>(d))));
            }
        }
        CHECK(e.state(W::sensitivity(decay::x, 3))[i] == 0);  // nothing depends on it
        CHECK(e.state(W::sensitivity(decay::w, 3))[i] == 0);
    }
}

TEST_CASE("without error control of sensitivities the solution has the bits that it has without them") {
    const auto fill = [](auto& e) {
        e.parameter(decay::k).setLinSpaced(0.5, 1.5);
        e.parameter(decay::unused) = 7;
        e.shared(decay::B) = 0.4;
        e.shared(decay::other) = 3;
        e.state(decay::x) = 2;
        e.state(decay::w) = 0;
        e.time_domain(0, 3);
    };
    myriad::ensemble<decay_by_all> e(64);
    myriad::ensemble<decay> alone(64);
    fill(e);
    fill(alone);
    myriad::initial_sensitivities(e);
    myriad::options o = with_tolerance(1e-8);
    o.step = 1e-3;
    myriad::solve<myriad::tsitouras_5>(tests::test_device(), alone, o);
    o.relative_tolerance = o.absolute_tolerance = myriad::without_tangents<decay_by_all>(1e-8);
    myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, o);
    myriad::ensemble<uncontrolled_decay> cheap(64);
    fill(cheap);
    myriad::initial_sensitivities(cheap);
    myriad::solve<myriad::tsitouras_5>(tests::test_device(), cheap, o);
    for (int c = 0; c < uncontrolled_decay::n_state; ++c)
        for (Index i = 0; i < e.size(); ++i) CHECK_THAT(cheap.state(c)[i], near(e.state(c)[i]));
    if (!tests::tests_cpu()) return;
    for (int c = 0; c < decay::n_state; ++c) {
        CHECK(same_bits_everywhere(e.state(c), alone.state(c)));
        CHECK(same_bits_everywhere(cheap.state(c), alone.state(c)));
    }
}

TEST_CASE("a sensitivity without error control that overflows ends its instance as not finite") {
    myriad::ensemble<uncontrolled_decay> e(2);
    e.parameter(decay::k) << 1, -1;
    e.parameter(decay::unused) = 0;
    e.shared(decay::B) = 0;
    e.shared(decay::other) = 0;
    e.state(decay::x) = 1;
    e.state(decay::w) = 0;
    e.time_domain(0, 1);
    myriad::initial_sensitivities(e);
    e.state(uncontrolled_decay::sensitivity(decay::x, 1)) << 1e300, 1e308;  // times exp(-k) at the end
    myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, with_tolerance(1e-8));
    CHECK(e.status(0) == myriad::status::success);
    CHECK(e.status(1) == myriad::status::not_finite);
}

TEST_CASE("sensitivities pass impacts, and accessories that actions set have them too") {
    using W = ball_by_all;
    myriad::ensemble<W> e(3);
    throw_ball(e, 0);
    e.time_domain(0, 6);
    const auto report = myriad::solve<myriad::dense<myriad::tsitouras_5>>(tests::test_device(), e, falling);
    REQUIRE(report.count(myriad::status::success) == e.size());
    const flight expected = fly(thrown, 6);
    REQUIRE(expected.bounces >= 3);
    CHECK(e.integer_accessory(ball::bounces)[0] == expected.bounces);
    for (int d = 0; d < 5; ++d) {
        CAPTURE(d);
        const auto by = [&](long double flight::*part) {
            return near(
                derivative([&](const numbers& p) { return fly(p, 6).*part; }, thrown, static_cast<std::size_t>(d)));
        };
        CHECK_THAT(e.state(W::sensitivity(ball::x, d))[1], by(&flight::x));
        CHECK_THAT(e.state(W::sensitivity(ball::v, d))[1], by(&flight::v));
        CHECK_THAT(e.accessory(W::accessory_sensitivity(ball::t_impact, d))[1], by(&flight::t_impact));
        CHECK_THAT(e.accessory(W::accessory_sensitivity(ball::speed, d))[1], by(&flight::speed));
        CHECK(e.accessory(W::time_sensitivity(d))[1] == 0);
        CHECK(e.accessory(W::undefined)[1] == 0);
    }
}

TEST_CASE("where an event ends the phase, sensitivities are those of the values there, and of the time") {
    using W = ball_by_all;
    myriad::ensemble<W> e(3);
    throw_ball(e, 2);
    e.time_domain(0, 100);
    myriad::solve<myriad::dense<myriad::tsitouras_5>>(tests::test_device(), e, falling);
    CHECK(e.status(0) == myriad::status::stopped_by_user);
    for (int d = 0; d < 5; ++d) {
        CAPTURE(d);
        const auto by = [&](long double flight::*part) {
            return near(derivative([&](const numbers& p) { return fly(p, 100, 2).*part; }, thrown,
                                   static_cast<std::size_t>(d)));
        };
        CHECK_THAT(e.state(W::sensitivity(ball::x, d))[1], by(&flight::x));  // of the floor: 1 by its height
        CHECK_THAT(e.state(W::sensitivity(ball::v, d))[1], by(&flight::v));
        CHECK_THAT(e.accessory(W::time_sensitivity(d))[1], by(&flight::t_impact));
    }
}

TEST_CASE("a phase that carries on from an event has the sensitivities of one phase") {
    using W = ball_by_all;
    myriad::ensemble<W> e(3), whole(3);
    throw_ball(e, 2);
    throw_ball(whole, 0);
    e.time_domain(0, 6);
    whole.time_domain(0, 6);
    myriad::options o = falling;
    o.phase_time = myriad::phase_time::carry_on;
    o.phases = 2;
    myriad::solve<myriad::dense<myriad::tsitouras_5>>(tests::test_device(), e, o);
    myriad::solve<myriad::dense<myriad::tsitouras_5>>(tests::test_device(), whole, falling);
    REQUIRE((e.phases_done() == 2).all());
    for (int c = 0; c < W::n_state; ++c) CHECK_THAT(e.state(c)[0], near(whole.state(c)[0]));
}

TEST_CASE("a phase that starts anew after one that an event ended has the sensitivities of its start") {
    // The first phase ends at an impact; the second flight is longer than the time domain.
    using W = ball_by_all;
    myriad::ensemble<W> e(3);
    throw_ball(e, 2);
    e.time_domain(0, 1.8);
    myriad::options o = falling;
    o.phases = 2;
    o.events[0].stop_after = 1;
    myriad::solve<myriad::dense<myriad::tsitouras_5>>(tests::test_device(), e, o);
    REQUIRE((e.phases_done() == 2).all());
    REQUIRE(e.status(0) == myriad::status::success);
    for (int d = 0; d < 5; ++d) {
        CAPTURE(d);
        const auto x = [&](const numbers& p) {
            const flight first = fly(p, 100, 1);
            return fly({p[0], p[1], p[2], first.x, first.v}, 1.8L).x;
        };
        CHECK_THAT(e.state(W::sensitivity(ball::x, d))[1], near(derivative(x, thrown, static_cast<std::size_t>(d))));
    }
}

TEST_CASE("an event without an action that ends a phase has the sensitivities of its time") {
    using W = ramp_by_all;
    myriad::ensemble<W> e(3);
    e.parameter(ramp::a) = 0.5;
    e.parameter(ramp::top) = 2;
    e.state(ramp::x) = 0.3;
    myriad::initial_sensitivities(e);
    e.time_domain(0, 100);
    myriad::options o = with_tolerance(1e-10);
    o.events = {{.stop_after = 1}};
    myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, o);
    REQUIRE(e.status(0) == myriad::status::stopped_by_event);
    const auto time = [](const numbers& p) { return std::sqrt(2 * (p[1] - p[2]) / p[0]); };
    const numbers at = {0.5L, 2, 0.3L};
    for (int d = 0; d < 3; ++d) {
        CHECK_THAT(e.accessory(W::time_sensitivity(d))[0], near(derivative(time, at, static_cast<std::size_t>(d))));
        CHECK_THAT(e.state(W::sensitivity(ramp::x, d))[0], near(d == 1 ? 1 : 0));  // it ends at `top`
    }
}

TEST_CASE("sensitivities pass stop times that are parameters, and rates that hooks compute from the state") {
    using W = dose_by_all;
    myriad::ensemble<W> e(3);
    e.parameter(dose::time) = 0.7;
    e.parameter(dose::amount) = 0.6;
    e.parameter(dose::k) = 0.9;
    e.state(dose::x) = 1.2;
    myriad::initial_sensitivities(e);
    e.time_domain(0, 2);
    myriad::options o = with_tolerance(1e-10);
    o.phases = 2;
    myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, o);
    REQUIRE((e.phases_done() == 2).all());
    const auto phase = [](const numbers& p, long double x) {
        const long double rate = p[2] * x;
        return p[2] * ((x * std::exp(-rate * p[0]) + p[1]) * std::exp(-rate * (2 - p[0])));
    };
    const numbers at = {0.7L, 0.6L, 0.9L, 1.2L};
    const auto x = [&](const numbers& p) { return phase(p, phase(p, p[3])); };
    const auto rate = [&](const numbers& p) { return p[2] * phase(p, p[3]); };
    for (int d = 0; d < 4; ++d) {
        CAPTURE(d);
        const auto i = static_cast<std::size_t>(d);
        CHECK_THAT(e.state(W::sensitivity(dose::x, d))[0], near(derivative(x, at, i)));
        CHECK_THAT(e.accessory(W::accessory_sensitivity(dose::rate, d))[0], near(derivative(rate, at, i)));
    }
}

TEST_CASE("a surface that is passed with no slope has no sensitivity of its time, and no number stands for it") {
    using W = inflection_by_c;
    myriad::ensemble<W> e(2);
    e.parameter(inflection::c) = 1;
    e.parameter(inflection::jump) << 0, 1;
    e.state(inflection::x) = -1;
    e.state(inflection::w) = 0;
    myriad::initial_sensitivities(e);
    e.time_domain(0, 2);
    myriad::options o = with_tolerance(1e-10);
    o.step = o.maximum_step = 0.5;  // so that a step ends at the very time
    myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, o);
    REQUIRE(e.accessory(inflection::t_zero)[0] == 1);
    CHECK(e.status(0) == myriad::status::success);
    CHECK(std::isnan(e.accessory(W::accessory_sensitivity(inflection::t_zero))[0]));
    CHECK_THAT(e.accessory(W::accessory_sensitivity(inflection::highest))[0], near(-3 + 3));  // as x, at t = 2
    CHECK(e.accessory(W::undefined)[0] == 1);
    CHECK_THAT(e.state(W::sensitivity(inflection::x))[0], near(-3 + 3));  // (t - c)^3 + c^3 - 1, at t = 2
    CHECK(e.status(1) == myriad::status::not_finite);                     // where a state would have the derivative
    CHECK(e.accessory(W::undefined)[1] == 1);
}
