// SPDX-License-Identifier: MIT
// Samples where the state jumps at events, where events end phases, and where a hook moves the end of the phase.
#include <algorithm>

#include "tests/kernel/output/sampling.hpp"
#include "tests/support/prepared.hpp"

using namespace output;

namespace {

constexpr double event_tolerance = 1e-12;

/// Chosen so that no impact coincides with a sample, whose time would come before and after the action.
double height(std::int64_t i) { return 1.01 + 0.0625 * static_cast<double>(i); }

/// Balls from different heights, whose impacts come at different times.
ensemble<bouncing> balls(std::int64_t size = 37, double t_end = 5) {
    ensemble<bouncing> e(size);
    for (std::int64_t i = 0; i < size; ++i) {
        e.state(bouncing::x)[i] = height(i);
        e.state(bouncing::v)[i] = 0;
        e.parameter(bouncing::g)[i] = 2 + 0.125 * static_cast<double>(i % 8);
        e.parameter(bouncing::r)[i] = 0.75;
    }
    e.time_domain(0, t_end);
    return e;
}

options bounces(std::int64_t evenly) {
    options o = compare::with_tolerance(1e-9);
    o.events = {{.direction = myriad::direction::falling, .tolerance = event_tolerance}};
    o.samples.states = {bouncing::x, bouncing::v};
    o.samples.evenly = evenly;
    o.samples.capacity = evenly;
    return o;
}

/// Height and speed at time t, in closed form, and the distance in time to the nearest impact.
struct flight {
    double x, v, to_impact;

    flight(double x0, double g, double r, double t) {
        double speed = std::sqrt(2 * g * x0), since = t - std::sqrt(2 * x0 / g);
        if (since < 0) {
            x = x0 - 0.5 * g * t * t;
            v = -g * t;
            to_impact = -since;
            return;
        }
        speed *= r;
        while (since > 2 * speed / g) {
            since -= 2 * speed / g;
            speed *= r;
        }
        x = since * (speed - 0.5 * g * since);
        v = speed - g * since;
        to_impact = std::min(since, 2 * speed / g - since);
    }
};

}  // namespace

TEST_CASE("samples across events lie on the exact solution, before and after every jump", "[output]") {
    each_dense_method([]<class Dense, class Method> {
        // few samples in a step, and many
        for (const double step : {1.0 / 64, 0.5}) {
            auto e = balls();
            options o = compare::fixed_step(step);
            const options b = bounces(997);
            o.events = b.events;
            o.samples = b.samples;
            solve<Dense>(tests::test_device(1), e, o);
            CHECK((e.samples().stored() == 997).all());
            double worst = 0;
            int near_jumps = 0;
            for (std::int64_t i = 0; i < e.size(); ++i) {
                for (int k = 0; k < 997; ++k) {
                    const double t = e.samples().time()(i, k);
                    const flight exact(height(i), e.parameter(bouncing::g)[i], e.parameter(bouncing::r)[i], t);
                    if (exact.to_impact < 1e-9) continue;  // the side of the jump is undetermined
                    near_jumps += exact.to_impact < 0.01;
                    const double off = std::max(std::abs(e.samples().state(bouncing::x)(i, k) - exact.x),
                                                std::abs(e.samples().state(bouncing::v)(i, k) - exact.v));
                    worst = off <= worst ? worst : off;
                }
            }
            CAPTURE(step, worst);
            CHECK(near_jumps > 300);
            // Every impact is located to 1e-12 in x, that is 1e-12 / v in t; at most ten impacts, none slower than
            // 0.75^10 of 2: each has an error of 2e-11 in time, which the acceleration of 3 turns into errors of v.
            CHECK(worst <= 10 * 3 * 2e-11);
        }
    });
}

TEST_CASE("a sample at the instant of an event shows the state before the action, however the time rounds",
          "[output]") {
    // x = c^2 - t^2 falls to zero at c; in some of 2000 instances rounding puts the event a little before
    each_dense_method([]<class Dense, class Method> {
        constexpr int size = 2000;
        for (const double tolerance : {0.0, 1e-15}) {
            ensemble<bouncing> e(size);
            options o = bounces(0);
            for (int i = 0; i < size; ++i) {
                const double t = 0.1 + 0.0021 * (i + 1);
                e.state(bouncing::x)[i] = t * t;
                o.samples.times_of_instances.push_back(t);
            }
            e.state(bouncing::v) = 0;
            e.parameter(bouncing::g) = 2;
            e.parameter(bouncing::r) = 0.75;
            e.time_domain(0, 4.5);
            o.samples.capacity = 1;
            o.step = 0.5;
            o.events[0].tolerance = tolerance;
            solve<Dense>(tests::test_device(1), e, o);
            int after = 0;
            for (int i = 0; i < size; ++i) after += !(e.samples().state(bouncing::v)(i, 0) < 0);
            CAPTURE(tolerance);
            CHECK(after == 0);
        }
    });
}

TEST_CASE("samples across events do not depend on the pack", "[output]") {
    // parabolas use only + - * /, so that a scalar lane and a pack agree bit for bit
    for (const std::int64_t every : {0, 1}) {
        options o = bounces(101);
        o.samples.evenly = every == 0 ? 101 : 0;
        o.samples.every = every;
        o.samples.capacity = 400;
        auto packs = balls(), lane = balls();
        solve<dense<cash_karp>>(device::cpu(1), packs, o);

        run_one_lane<bouncing, dense<cash_karp>>(tests::prepare<dense<cash_karp>>(lane, o).arguments(), {});
        CHECK((packs.samples().stored() >= (every == 0 ? 101 : 5)).all());
        CHECK(same_samples(packs, lane));
        CHECK(compare::difference(packs, lane) == "");
    }
}

TEST_CASE("samples by steps show the state before the action of an event, once", "[output]") {
    each_dense_method([]<class Dense, class Method> {
        auto e = balls();
        options o = bounces(0);
        o.samples.every = 1;
        o.samples.capacity = 2000;
        solve<Dense>(tests::test_device(1), e, o);
        for (std::int64_t i = 0; i < e.size(); ++i) {
            const int n = e.samples().stored()[i];
            REQUIRE(n == e.accepted_steps()[i] + 1);
            int impacts = 0;
            for (int k = 1; k < n; ++k) {
                CHECK(e.samples().time()(i, k) > e.samples().time()(i, k - 1));
                if (e.samples().state(bouncing::x)(i, k) > event_tolerance) continue;
                ++impacts;
                CHECK(e.samples().state(bouncing::v)(i, k) < 0);
            }
            CHECK(impacts >= 2);
        }
    });
}

TEST_CASE("a phase that an event ends has the samples up to the event", "[output]") {
    each_dense_method([]<class Dense, class Method> {
        auto e = balls();
        options o = bounces(101);
        o.events[0].stop_after = 2;
        solve<Dense>(tests::test_device(1), e, o);
        for (std::int64_t i = 0; i < e.size(); ++i) {
            REQUIRE(e.status(i) == status::stopped_by_event);
            const int n = e.samples().stored()[i];
            CHECK(n == std::floor(e.t()[i] / 0.05) + 1);  // a hundredth of the domain each
            CHECK(e.samples().time()(i, n - 1) <= e.t()[i]);
            CHECK(std::isnan(e.samples().time()(i, n)));
        }
    });
}

TEST_CASE("phases that an event ends and that carry time on sample every time once", "[output]") {
    each_dense_method([]<class Dense, class Method> {
        auto e = balls(), whole = balls();
        options o = bounces(101);
        solve<Dense>(tests::test_device(1), whole, o);
        o.phases = 6;
        o.samples.capacity = 606;
        o.phase_time = myriad::phase_time::carry_on;
        o.events[0].stop_after = 1;
        solve<Dense>(tests::test_device(1), e, o);
        for (std::int64_t i = 0; i < e.size(); ++i) {
            const int n = e.samples().stored()[i];
            REQUIRE(n >= 60);
            for (int k = 1; k < n; ++k) CHECK(e.samples().time()(i, k) > e.samples().time()(i, k - 1));
            for (int k = 0; k < n; ++k) CHECK(e.samples().time()(i, k) == whole.samples().time()(i, k));
        }
    });
}

TEST_CASE("a sample on the very end of a phase that carries time on is stored once", "[output]") {
    each_dense_method([]<class Dense, class Method> {
        auto e = balls();
        options o = bounces(0);
        o.samples.times = {0.25, 0.5, 0.625};
        o.samples.capacity = 10;
        o.phase_time = myriad::phase_time::carry_on;
        for (const double t_end : {0.5, 1.0}) {
            e.t_end() = t_end;
            if (t_end == 0.5) o.samples.times.pop_back();
            solve<Dense>(tests::test_device(1), e, o);
            o.samples.times = {0.25, 0.5, 0.625};
        }
        for (std::int64_t i = 0; i < e.size(); ++i) {
            REQUIRE(e.samples().stored()[i] == 3);
            for (const int k : {0, 1, 2}) CHECK(e.samples().time()(i, k) == (k == 0 ? 0.25 : k == 1 ? 0.5 : 0.625));
        }
    });
}

TEST_CASE("a domain of length zero has one evenly spaced sample", "[output]") {
    each_dense_method([]<class Dense, class Method> {
        auto e = balls();
        e.time_domain(2, 2);
        solve<Dense>(tests::test_device(1), e, bounces(3));
        CHECK((e.samples().stored() == 1).all());
        for (std::int64_t i = 0; i < e.size(); ++i)
            CHECK((e.samples().time()(i, 0) == 2 && e.samples().state(0)(i, 0) == height(i)));
    });
}

// --------------------------------------------------------------------------------------------------------------------
// A hook moves the end of the phase
// --------------------------------------------------------------------------------------------------------------------

namespace {

ensemble<retargeted> moving(double when, double new_end) {
    ensemble<retargeted> e(11);
    e.state(retargeted::x) = 0.0;
    e.parameter(retargeted::when) = when;
    e.parameter(retargeted::new_end) = new_end;
    e.time_domain(0, 1);
    return e;
}

options moved(std::int64_t evenly) {
    options o = compare::fixed_step(1.0 / 32);
    o.samples.states = {retargeted::x};
    o.samples.evenly = evenly;
    o.samples.capacity = 200;
    return o;
}

template <class Test>
void both_kinds(Test test) {
    test.template operator()<dense<runge_kutta_4>>();
    test.template operator()<dense<cash_karp>>();
}

}  // namespace

TEST_CASE("a phase that a hook turns round takes no sample beyond the turn", "[output]") {
    both_kinds([]<class Dense> {
        for (const bool given : {false, true}) {
            auto e = moving(0.5, -1);
            options o = moved(given ? 0 : 21);
            if (given) o.samples.times = {0.1, 0.3, 0.5001, 0.9};
            solve<Dense>(tests::test_device(1), e, o);
            REQUIRE(e.t()[0] == -1);
            for (std::int64_t i = 0; i < e.size(); ++i) {
                const int n = e.samples().stored()[i];
                REQUIRE(n == (given ? 2 : 11));
                for (int k = 0; k < n; ++k) {
                    CHECK(e.samples().time()(i, k) <= 0.5);
                    // x = t to the rounding of some steps
                    CHECK(std::abs(e.samples().state(0)(i, k) - e.samples().time()(i, k)) <= 32 * eps_of<double>);
                }
            }
        }
    });
}

TEST_CASE("evenly spaced samples keep their times where a hook moves the end of the phase", "[output]") {
    // They divide the domain with which the phase began.
    both_kinds([]<class Dense> {
        for (const double new_end : {0.75, 2.0}) {
            auto e = moving(0.5, new_end);
            solve<Dense>(tests::test_device(1), e, moved(21));
            REQUIRE(e.t()[0] == new_end);
            for (std::int64_t i = 0; i < e.size(); ++i) {
                const int n = e.samples().stored()[i];
                REQUIRE(n == (new_end < 1 ? 16 : 21));
                for (int k = 0; k < n; ++k) {
                    CHECK(std::abs(e.samples().time()(i, k) - k / 20.0) <= eps_of<double>);
                    CHECK(std::abs(e.samples().state(0)(i, k) - e.samples().time()(i, k)) <= 64 * eps_of<double>);
                }
            }
        }
    });
}
