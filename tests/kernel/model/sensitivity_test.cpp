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
    e.parameter(ramp::before) = e.parameter(ramp::after) = 1000;  // never
    e.state(ramp::x) = 0.3;
    myriad::initial_sensitivities(e);
    e.time_domain(0, 100);
    myriad::options o = with_tolerance(1e-10);
    o.events = {{}, {.stop_after = 1}, {}};
    myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, o);
    REQUIRE(e.status(0) == myriad::status::stopped_by_event);
    const auto time = [](const numbers& p) { return std::sqrt(2 * (p[1] - p[2]) / p[0]); };
    const numbers at = {0.5L, 2, 0.3L};
    for (int d = 0; d < 3; ++d) {
        CHECK_THAT(e.accessory(W::time_sensitivity(d))[0], near(derivative(time, at, static_cast<std::size_t>(d))));
        CHECK_THAT(e.state(W::sensitivity(ramp::x, d))[0], near(d == 1 ? 1 : 0));  // it ends at `top`
    }
}

TEST_CASE(
    "the time at which a phase ended has the derivatives of the event that ended it, not of others at that instant") {
    using W = ramp_by_times;  // by the level, the time of the event before it, and that of the event behind it
    for (int ending = 0; ending < 3; ++ending) {
        CAPTURE(ending);
        myriad::ensemble<W> e(3);
        e.parameter(ramp::a) = 0.5;
        e.parameter(ramp::top) = 1;
        e.parameter(ramp::before) = e.parameter(ramp::after) = 2;  // where x = t^2 / 4 = 1
        e.state(ramp::x) = 0;
        myriad::initial_sensitivities(e);
        e.time_domain(0, 100);
        myriad::options o = with_tolerance(1e-10);
        o.events = {{}, {}, {}};
        o.events[static_cast<std::size_t>(ending)].stop_after = 1;
        myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, o);
        REQUIRE(e.status(0) == myriad::status::stopped_by_event);
        for (int d = 0; d < 3; ++d) {
            const bool own = d == (ending == 1 ? 0 : ending == 0 ? 1 : 2);
            // dt/d top is 1 / slope, and the slope is 1 there
            CHECK_THAT(e.accessory(W::time_sensitivity(d))[0], near(own ? 1 : 0));
            CHECK_THAT(e.state(W::sensitivity(ramp::x, d))[0], near(own ? 1 : 0));
        }
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

TEST_CASE("sensitivities by the ends of the time domain are those of a closed form, forwards and backwards") {
    using W = decay_by_domain;  // by t_end, k, t_begin
    myriad::ensemble<W> e(2);
    e.parameter(decay::k) = 0.7;
    e.parameter(decay::unused) = 7;
    e.shared(decay::B) = 0.4;
    e.shared(decay::other) = 3;
    e.state(decay::x) = 2;
    e.state(decay::w) = 0;
    myriad::initial_sensitivities(e);
    e.t_begin() << 0.5, 3;
    e.t_end() << 3, 0.5;
    myriad::options o = with_tolerance(1e-10);
    std::vector<int> all;
    for (int c = 0; c < W::n_state; ++c) all.push_back(c);
    o.samples = {.states = all, .capacity = 2, .evenly = 2};
    const auto report = myriad::solve<myriad::dense<myriad::tsitouras_5>>(tests::test_device(), e, o);
    REQUIRE(report.count(myriad::status::success) == e.size());
    for (Index i = 0; i < e.size(); ++i) {
        const long double begin = static_cast<long double>(e.t_begin()[i]),
                          end = static_cast<long double>(e.t_end()[i]);
        const auto x = [](const numbers& p) {  // of the time, k and the begin
            return 0.4L / p[1] + (2 - 0.4L / p[1]) * std::exp(-p[1] * (p[0] - p[2]));
        };
        const auto w = [&](const numbers& p) {  // by Gauss' rule in each of 40 parts
            long double sum = 0;
            const long double part = (p[0] - p[2]) / 40, off = std::sqrt(0.6L) / 2;
            for (int j = 0; j < 40; ++j)
                for (const long double node : {-off, 0.0L, off}) {
                    const long double t = p[2] + part * (static_cast<long double>(j) + 0.5L + node);
                    sum += part * (node == 0 ? 4.0L / 9 : 5.0L / 18) * std::cos(p[1] * t) * x({t, p[1], p[2]});
                }
            return sum;
        };
        for (int d = 0; d < 3; ++d) {
            CAPTURE(i, d);
            const auto of = static_cast<std::size_t>(d);
            CHECK_THAT(e.state(W::sensitivity(decay::x, d))[i], near(derivative(x, {end, 0.7L, begin}, of)));
            CHECK_THAT(e.state(W::sensitivity(decay::w, d))[i], near(derivative(w, {end, 0.7L, begin}, of)));
            CHECK(e.accessory(W::time_sensitivity(d))[i] == (d == 0 ? 1 : 0));
            for (const int sample : {0, 1}) {  // which stay at their times
                const long double t = sample == 0 ? begin : end;
                CHECK_THAT(e.samples().state(W::sensitivity(decay::x, d))(i, sample),
                           near(d == 0 ? 0 : derivative(x, {t, 0.7L, begin}, of)));
            }
        }
    }
}

namespace {

/// What `saw` gives, of a, top, x, t_begin and t_end.
struct saw_result {
    long double x, t, noted, begin, length, area;
};
/// One phase from t and x, of which the hooks see the given begin and end; it ends at fall `last`.
saw_result saw_phase(const numbers& p, long double t, long double x, long double begin, long double end, int last,
                     long double noted = 0) {
    saw_result s{x + t / 8, t, noted, begin * t, end - begin, 0};
    for (int falls = 0;;) {
        const long double a = p[0], zero = s.x - a * s.t * s.t / 2, hit = std::sqrt(2 * (p[1] - zero) / a);
        const long double to = std::min(hit, end), square = (to * to - s.t * s.t) / 2;
        s.area += zero * square + a * (to * to * to * to - s.t * s.t * s.t * s.t) / 8;
        s.x = zero + a * to * to / 2;
        s.t = to;
        if (to == end) return s;
        s.noted = to * end;
        s.x = s.x / 5 + to / 10;
        if (++falls == last) return s;
    }
}

}  // namespace

TEST_CASE("sensitivities by the ends of the time domain pass events, hooks, summaries and phases") {
    using W = saw_by_domain;
    const numbers at = {1.1L, 2.1L, 0.4L, 0.5L, 4.3L};
    struct {
        const char* name;
        int phases, last;
        bool carry_on;
        double length;
        std::function<saw_result(const numbers&)> expected;
    } const cases[] = {
        {"one phase", 1, 0, false, 0, [](const numbers& p) { return saw_phase(p, p[3], p[2], p[3], p[4], 0); }},
        {"two from t_begin", 2, 0, false, 0,
         [](const numbers& p) {
             const auto first = saw_phase(p, p[3], p[2], p[3], p[4], 0);
             return saw_phase(p, p[3], first.x - 1, p[3], p[4], 0);
         }},
        {"carried on from an event", 2, 2, true, 0,
         [](const numbers& p) {
             const auto first = saw_phase(p, p[3], p[2], p[3], p[4], 2);
             return saw_phase(p, first.t, first.x, p[3], p[4], 0, first.noted);
         }},
        {"ended by an event", 1, 2, true, 0, [](const numbers& p) { return saw_phase(p, p[3], p[2], p[3], p[4], 2); }},
        {"an end that is counted from t_begin", 2, 0, true, 1.4,
         [](const numbers& p) {
             const auto first = saw_phase(p, p[3], p[2], p[3], p[3] + 1.4L, 0);
             return saw_phase(p, first.t, first.x, p[3] + 1.4L, p[3] + 2.8L, 0, first.noted);
         }},
        {"the last of such phases", 3, 0, true, 1.4, [](const numbers& p) {
             const auto first = saw_phase(p, p[3], p[2], p[3], p[3] + 1.4L, 0);
             const auto second = saw_phase(p, first.t, first.x, p[3] + 1.4L, p[3] + 2.8L, 0, first.noted);
             return saw_phase(p, second.t, second.x, p[3] + 2.8L, p[4], 0, second.noted);
         }}};
    for (const auto& c : cases) {
        CAPTURE(c.name);
        myriad::ensemble<W> e(3);
        e.parameter(saw::a) = static_cast<double>(at[0]);
        e.parameter(saw::top) = static_cast<double>(at[1]);
        e.shared_integer(saw::last) = c.last;
        e.state(saw::x) = static_cast<double>(at[2]);
        myriad::initial_sensitivities(e);
        e.time_domain(static_cast<double>(at[3]), static_cast<double>(at[4]));
        myriad::options o = with_tolerance(1e-10);
        o.events = {{.direction = myriad::direction::rising}};
        o.phase_time = c.carry_on ? myriad::phase_time::carry_on : myriad::phase_time::restart;
        o.phase_length = c.length;
        o.phases = c.length > 0 ? c.phases : 1;
        while (e.phases_done()[0] < c.phases) {
            myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, o);
            if (e.phases_done()[0] == c.phases) break;
            e.shared_integer(saw::last) = 0;
            if (!c.carry_on) e.state(saw::x) -= 1;
        }
        const saw_result expected = c.expected(at);
        CHECK_THAT(e.state(saw::x)[1], near(static_cast<double>(expected.x)));
        CHECK_THAT(e.accessory(saw::area)[1], near(static_cast<double>(expected.area)));
        for (int d = 0; d < 5; ++d) {
            CAPTURE(d);
            const auto by = [&](long double saw_result::*part) {
                return near(
                    derivative([&](const numbers& p) { return c.expected(p).*part; }, at, static_cast<std::size_t>(d)));
            };
            CHECK_THAT(e.state(W::sensitivity(saw::x, d))[1], by(&saw_result::x));
            CHECK_THAT(e.accessory(W::time_sensitivity(d))[1], by(&saw_result::t));
            CHECK_THAT(e.accessory(W::accessory_sensitivity(saw::noted, d))[1], by(&saw_result::noted));
            CHECK_THAT(e.accessory(W::accessory_sensitivity(saw::begin, d))[1], by(&saw_result::begin));
            CHECK_THAT(e.accessory(W::accessory_sensitivity(saw::length, d))[1], by(&saw_result::length));
            CHECK_THAT(e.accessory(W::accessory_sensitivity(saw::area, d))[1], by(&saw_result::area));
        }
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
