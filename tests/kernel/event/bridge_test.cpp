// SPDX-License-Identifier: MIT
// Events on noisy paths: their laws against known ones, what they depend on, and what ends an instance.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/support/device.hpp"
#include "tests/support/noisy_events.hpp"

namespace {

using em = myriad::euler_maruyama;
using noisy::bouncing;
using noisy::growing;
using noisy::in_a_disc;
using noisy::walled;

constexpr double far = 1e6;
/// A statistic of a test may be off by so many of its standard errors: for ten thousand tests, one in a million.
constexpr double errors = 5;

template <class R = double>
myriad::ensemble<walled, R> start(std::int64_t paths, double t_end = 1000) {
    myriad::ensemble<walled, R> e(paths);
    const double values[walled::n_parameter] = {1, 0, 1, 1, -far, 0, 0};
    for (int c = 0; c < walled::n_parameter; ++c) e.parameter(c) = static_cast<R>(values[c]);
    e.state(walled::x) = R(0);
    e.time_domain(R(0), static_cast<R>(t_end));
    return e;
}
/// Options with which either event ends the phase.
myriad::options to_first(double step, std::int64_t stop_after = 1) {
    return {.step = step,
            .max_steps = 10'000'000,
            .seed = 7,
            .events = {{.stop_after = stop_after}, {.stop_after = stop_after}}};
}

struct moments {
    double mean, of_mean, variance, of_variance;  // with their standard errors
};
moments moments_of(const Eigen::ArrayXd& x) {
    const double n = static_cast<double>(x.size()), mean = x.mean();
    const double variance = (x - mean).square().mean(), fourth = (x - mean).pow(4).mean();
    return {mean, std::sqrt(variance / n), variance, std::sqrt((fourth - variance * variance) / n)};
}
template <class Ensemble>
std::int64_t count(const Ensemble& e, myriad::status which) {
    std::int64_t found = 0;
    for (std::int64_t i = 0; i < e.size(); ++i) found += e.statuses()[i] == which;
    return found;
}

}  // namespace

TEST_CASE("first passages of a Wiener process with a drift have the inverse Gaussian law, by steps of any length") {
    for (const double step : {0.02, 0.1, 0.8}) {
        auto e = start(20'000);
        myriad::solve<em>(tests::test_device(2), e, to_first(step));
        CHECK(count(e, myriad::status::stopped_by_event) == e.size());
        CHECK((e.state(walled::x) - 1).abs().maxCoeff() < 1e-14);
        const moments found = moments_of(e.t());
        INFO("step " << step);
        CHECK(found.mean == Approx(1).margin(errors * found.of_mean));
        CHECK(found.variance == Approx(1).margin(errors * found.of_variance));
        // P(t <= 1) of the inverse Gaussian distribution of mean and shape 1: Phi(0) + exp(2) Phi(-2).
        const double before = (e.t() <= 1).cast<double>().mean();
        CHECK(before ==
              Approx(0.5 + std::exp(2.0) * 0.5 * std::erfc(std::sqrt(2.0))).margin(errors * 0.5 / std::sqrt(20'000.0)));
    }
}

TEST_CASE("first passages of an Ornstein-Uhlenbeck process are off by the order of the step, and not of its root") {
    // The mean of the time from 0 to 1 of dx = -x dt + dW: sqrt(pi) times the integral of exp(u^2) (1 + erf u) to 1.
    double exact = 0;
    constexpr int parts = 1000;
    for (int k = 0; k < parts; ++k) {
        const double u = (k + 0.5) / parts;
        exact += std::sqrt(3.14159265358979324) * std::exp(u * u) * (1 + std::erf(u)) / parts;
    }
    for (const double step : {0.1, 0.02}) {
        auto e = start(40'000, 10'000);
        e.parameter(walled::drift) = 0;
        e.parameter(walled::pull) = 1;
        myriad::solve<em>(tests::test_device(2), e, to_first(step));
        const moments found = moments_of(e.t());
        // Looked at at the ends of steps it would be later by some 0.58 sqrt(step) times 7, the slope of the mean.
        INFO("step " << step << " mean " << found.mean << " exact " << exact);
        CHECK(found.mean == Approx(exact).margin(errors * found.of_mean + 4 * step));
    }
}

TEST_CASE("a Wiener process leaves an interval on its two sides with the right probabilities, and in the right time") {
    auto e = start(40'000);
    e.parameter(walled::drift) = 0;
    e.parameter(walled::upper) = 2;
    e.parameter(walled::lower) = -1;
    myriad::solve<em>(tests::test_device(2), e, to_first(0.1));
    const double above = (e.state(walled::x) > 0).cast<double>().mean();
    CHECK(above == Approx(1.0 / 3).margin(errors * 0.5 / 200));
    const moments found = moments_of(e.t());
    CHECK(found.mean == Approx(2).margin(errors * found.of_mean));
    CHECK((e.state(walled::x) - (e.state(walled::x) > 0).select(Eigen::ArrayXd::Constant(e.size(), 2), -1))
              .abs()
              .maxCoeff() < 1e-14);
}

TEST_CASE("passages after resets are independent of those before") {
    constexpr double t_end = 200;
    auto e = start(4000, t_end);
    e.parameter(walled::resets) = 1;
    myriad::solve<em>(tests::test_device(2), e, to_first(0.25, 0));
    CHECK(count(e, myriad::status::success) == e.size());
    const moments found = moments_of(e.accessory(walled::passages));
    // Of a renewal process with intervals of mean m and variance v: t / m + (v / m^2 - 1) / 2 and t v / m^3 as t grows.
    CHECK(found.mean == Approx(t_end).margin(errors * found.of_mean + 0.1));
    CHECK(found.variance == Approx(t_end).margin(errors * found.of_variance + 3));
}

TEST_CASE("a stop time that an event's action sets follows by as much") {
    auto e = start(100, 50);
    e.parameter(walled::rest) = 0.3;
    e.parameter(walled::upper) = 1;
    e.parameter(walled::drift) = 1;
    myriad::solve<em>(tests::test_device(), e,
                      {.phases = 1, .step = 0.25, .seed = 2, .events = {{.stop_after = 1}, {}}});
    CHECK((e.accessory(walled::last) - e.t()).abs().maxCoeff() == 0);

    auto rested = start(20'000, 50);
    rested.parameter(walled::rest) = 0.3;
    rested.parameter(walled::resets) = 1;
    rested.parameter(walled::sigma) = 0.5;
    myriad::solve<em>(tests::test_device(2), rested, {.step = 0.25, .seed = 2, .events = {{.stop_after = 2}, {}}});
    // The first passage takes a mean of 1, and the second as long after it, or if it is later than 0.3 after 0.3 more.
    const moments found = moments_of(rested.t());
    auto alone = start(200'000);
    alone.parameter(walled::sigma) = 0.5;
    auto options = to_first(0.25);
    options.seed = 31;
    myriad::solve<em>(tests::test_device(2), alone, options);
    const double late = (alone.t() > 0.3).cast<double>().mean();
    const double early_mean = (alone.t() <= 0.3).select(alone.t(), 0).mean();
    CHECK(found.mean == Approx(1 + early_mean + late * (0.3 + 1)).margin(errors * found.of_mean + 0.005));
}

TEST_CASE("events of curved functions and shared processes converge with the step") {
    const auto mean_exit = [](double step) {
        myriad::ensemble<in_a_disc> e(20'000);
        e.parameter(in_a_disc::radius) = 1;
        e.parameter(in_a_disc::line) = far;
        e.state(in_a_disc::x) = 0.2;
        e.state(in_a_disc::z) = 0;
        e.time_domain(0, 1000);
        myriad::solve<em>(tests::test_device(2), e, to_first(step));
        const Eigen::ArrayXd radius = (e.state(0).square() + e.state(1).square()).sqrt();
        CHECK((radius - 1).abs().maxCoeff() < 1e-9);
        CHECK(count(e, myriad::status::stopped_by_event) == e.size());
        return moments_of(e.t());
    };
    const moments coarse = mean_exit(0.05), fine = mean_exit(0.005);
    CHECK(coarse.mean == Approx(0.48).margin(errors * coarse.of_mean + 0.05));  // (1 - 0.2^2) / 2
    CHECK(fine.mean == Approx(0.48).margin(errors * fine.of_mean + 0.005));

    // x + z is a Wiener process of variance 2 t, that stays below 1 up to t = 1 with probability erf(1 / 2).
    myriad::ensemble<in_a_disc> e(20'000);
    e.parameter(in_a_disc::radius) = far;
    e.parameter(in_a_disc::line) = 1;
    e.state(in_a_disc::x) = 0;
    e.state(in_a_disc::z) = 0;
    e.time_domain(0, 1);
    myriad::solve<em>(tests::test_device(2), e, to_first(0.25));
    const double stays = static_cast<double>(count(e, myriad::status::success)) / 20'000;
    CHECK(stays == Approx(std::erf(0.5)).margin(errors * 0.5 / std::sqrt(20'000.0)));
    // Across the line, x - z is independent of when it is reached, and has the variance of its time.
    const Eigen::ArrayXd across = e.state(0) - e.state(1);
    CHECK((across.square() - 2 * e.t()).mean() == Approx(0).margin(errors * 3 / std::sqrt(20'000.0)));
    CHECK((e.t() < 1).select((e.state(0) + e.state(1) - 1).abs(), 0).maxCoeff() < 1e-14);
}

TEST_CASE("a function without noise of its own is located on the path, and its side is where it goes") {
    const auto bounce = [](auto method) {
        myriad::ensemble<bouncing> e(500);
        e.parameter(bouncing::gravity) = 1;
        e.parameter(bouncing::friction) = 0.5;
        e.parameter(bouncing::sigma) = 1;
        e.parameter(bouncing::restitution) = 1;
        e.state(bouncing::height) = 1;
        e.state(bouncing::velocity) = 0;
        e.accessory(bouncing::bounces) = 0;
        e.accessory(bouncing::lowest) = 0;
        e.time_domain(0, 100);
        myriad::solve<decltype(method)>(
            tests::test_device(2), e,
            {.step = 0.02, .seed = 5, .events = {{.direction = myriad::direction::falling, .tolerance = 1e-12}}});
        CHECK(count(e, myriad::status::success) == e.size());
        CHECK(e.accessory(bouncing::lowest).minCoeff() > -1e-10);
        CHECK(e.accessory(bouncing::bounces).minCoeff() > 10);
        // In equilibrium the velocity has the variance sigma^2 / (2 friction) = 1, and the mean height is 1.
        CHECK(e.state(bouncing::velocity).square().mean() == Approx(1).margin(errors * std::sqrt(2.0 / 500)));
        CHECK(e.state(bouncing::height).mean() == Approx(1).margin(errors / std::sqrt(500.0)));
    };
    bounce(myriad::euler_maruyama());
    bounce(myriad::stochastic_heun());
}

TEST_CASE("multiplicative noise, with methods of several orders, and events of time alone") {
    const auto reach = [](auto method, double step) {
        myriad::ensemble<growing> e(20'000);
        e.parameter(growing::rate) = 1;
        e.parameter(growing::sigma) = 0.5;
        e.parameter(growing::level) = 2;
        e.parameter(growing::time) = far;
        e.state(growing::x) = 1;
        e.time_domain(0, 1000);
        myriad::solve<decltype(method)>(tests::test_device(2), e, to_first(step));
        CHECK((e.state(growing::x) - 2).abs().maxCoeff() < 1e-9);
        return moments_of(e.t());
    };
    const double exact = std::log(2.0) / (1 - 0.125);
    for (const double step : {0.1, 0.02}) {
        INFO("step " << step);
        for (const moments& found : {reach(myriad::milstein(), step), reach(myriad::sriw1(), step)})
            CHECK(found.mean == Approx(exact).margin(errors * found.of_mean + 0.5 * step));
    }
    myriad::ensemble<growing> e(100);
    e.parameter(growing::rate) = 1;
    e.parameter(growing::sigma) = 0.5;
    e.parameter(growing::level) = far;
    e.parameter(growing::time) = Eigen::ArrayXd::LinSpaced(100, 0.1, 1.5);
    e.state(growing::x) = 1;
    e.time_domain(0, 2);
    myriad::solve<myriad::milstein>(tests::test_device(), e, to_first(0.25));
    CHECK((e.t() - e.parameter(growing::time)).abs().maxCoeff() < 1e-15);
}

TEST_CASE("events of a path are the same alone, among others, by any number of threads, and in a chunk") {
    const auto prepare = [](auto& e) {
        e.parameter(walled::resets) = 1;
        e.parameter(walled::pull) = 0.125F;
        e.parameter(walled::lower) = -0.5F;
    };
    const auto different = [](const auto& all, const auto& some, std::int64_t first) {
        std::int64_t found = 0;
        for (std::int64_t i = 0; i < some.size(); ++i)
            found += all.state(0)[first + i] != some.state(0)[i] ||
                     all.accessory(walled::last)[first + i] != some.accessory(walled::last)[i];
        return found;
    };
    const auto compare = [&](auto number) {
        using R = decltype(number);
        auto all = start<R>(203, 20), again = start<R>(203, 20), alone = start<R>(1, 20), chunk = start<R>(7, 20);
        prepare(all), prepare(again), prepare(alone), prepare(chunk);
        auto o = to_first(0.1, 0);
        myriad::solve<em>(tests::test_device(), all, o);
        CHECK(all.accessory(walled::passages).minCoeff() > 5);
        myriad::host::ensemble_access::data(alone).first_index = 77;
        myriad::host::ensemble_access::data(chunk).first_index = 190;
        myriad::solve<em>(tests::test_device(), alone, o);
        myriad::solve<em>(tests::test_device(), chunk, o);
        o.schedule = myriad::schedule::dynamic;
        myriad::solve<em>(tests::test_device(3), again, o);
        CHECK(different(all, again, 0) == 0);
        CHECK(different(all, alone, 77) == 0);
        CHECK(different(all, chunk, 190) == 0);
    };
    compare(0.0);
    compare(0.0F);
}

TEST_CASE("phases that events end go on along paths of their own, the same in one call and in several") {
    const auto options = [](int phases) {
        auto o = to_first(0.2);
        o.phases = phases;
        o.phase_time = myriad::phase_time::carry_on;
        return o;
    };
    auto at_once = start(5000), in_parts = start(5000);
    at_once.parameter(walled::resets) = in_parts.parameter(walled::resets) = 1;
    myriad::solve<em>(tests::test_device(), at_once, options(4));
    for (int call = 0; call < 2; ++call) myriad::solve<em>(tests::test_device(), in_parts, options(2));
    CHECK((at_once.t() - in_parts.t()).abs().maxCoeff() == 0);
    const moments found = moments_of(at_once.t());
    CHECK(found.mean == Approx(4).margin(errors * found.of_mean));
    CHECK(found.variance == Approx(4).margin(errors * found.of_variance));
}

TEST_CASE("methods of higher order and backwards in time pass through the same laws") {
    auto e = start(20'000);
    myriad::solve<myriad::sra1>(tests::test_device(2), e, to_first(0.3));
    moments found = moments_of(e.t());
    CHECK(found.mean == Approx(1).margin(errors * found.of_mean));
    CHECK(found.variance == Approx(1).margin(errors * found.of_variance));
    auto backwards = start(20'000);
    backwards.time_domain(0, -1000);
    backwards.parameter(walled::drift) = -1;
    myriad::solve<em>(tests::test_device(2), backwards, to_first(0.3));
    found = moments_of(-backwards.t());
    CHECK(found.mean == Approx(1).margin(errors * found.of_mean));
    CHECK(found.variance == Approx(1).margin(errors * found.of_variance));
}

TEST_CASE("an event whose action leaves its function at zero happens without end under noise") {
    auto e = start(50);
    myriad::solve<em>(tests::test_device(), e, to_first(0.1, 0));
    CHECK(count(e, myriad::status::event_accumulation) == e.size());
    CHECK((e.state(walled::x) - 1).abs().maxCoeff() < 1e-14);
    auto begun_there = start(50);
    begun_there.state(walled::x) = 1;
    myriad::solve<em>(tests::test_device(), begun_there, to_first(0.1));
    CHECK(count(begun_there, myriad::status::event_accumulation) == begun_there.size());
    auto switched_off = start(50, 3);
    switched_off.state(walled::x) = 1;
    auto o = to_first(0.1);
    o.events[walled::above].direction = myriad::direction::none;
    myriad::solve<em>(tests::test_device(), switched_off, o);
    CHECK(count(switched_off, myriad::status::success) == switched_off.size());
}

TEST_CASE("only crossings from the side asked for are events on noisy paths") {
    auto e = start(1000, 2);
    e.parameter(walled::upper) = -0.5;
    e.parameter(walled::drift) = 3;
    auto o = to_first(0.1);
    o.events[walled::above].direction = myriad::direction::falling;
    myriad::solve<em>(tests::test_device(), e, o);
    // From 0.5 above with drift 3 the level is reached with probability exp(-2 3 0.5).
    const double reached = static_cast<double>(count(e, myriad::status::stopped_by_event)) / 1000;
    CHECK(reached == Approx(std::exp(-3.0)).margin(errors * std::sqrt(0.05 / 1000)));
}

TEST_CASE("samples after an event are those of the path that goes on there") {
    auto e = start(2, 6);
    e.parameter(walled::resets) = 1;
    e.parameter(walled::sigma) = 0.1;
    myriad::solve<myriad::dense<em>>(
        tests::test_device(), e,
        {.step = 0.25, .seed = 2, .samples = {.states = {walled::x}, .capacity = 120, .evenly = 120}});
    double highest = -1;
    for (int k = 0; k < 120; ++k) highest = std::max(highest, e.samples().state(walled::x)(0, k));
    CHECK(highest <= 1);
    CHECK(highest > 0.8);
}

TEST_CASE("extrema of a Wiener process and their times have their laws, whatever the steps") {
    using noisy::wandering;
    constexpr std::int64_t paths = 40'000;
    const double deviation = 1 / std::sqrt(static_cast<double>(paths));
    const auto normal = [](double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); };
    const auto wander = [&](double step, double drift) {
        myriad::ensemble<wandering> e(paths);
        e.state(wandering::x) = 0;
        e.parameter(wandering::drift) = drift;
        e.time_domain(0, 1);
        myriad::solve<em>(tests::test_device(2), e, {.step = step, .seed = 3});
        return e;
    };
    for (const double step : {1.0, 0.25, 0.01}) {
        INFO("step " << step);
        const auto e = wander(step, 0);
        for (const bool up : {true, false}) {
            const Eigen::ArrayXd far_out = (up ? 1.0 : -1.0) * e.accessory(up ? wandering::highest : wandering::lowest);
            const Eigen::ArrayXd when = e.accessory(up ? wandering::when_highest : wandering::when_lowest);
            const moments found = moments_of(far_out);  // as the size of a normal number
            CHECK(found.mean == Approx(std::sqrt(2 / 3.14159265358979324)).margin(errors * found.of_mean));
            CHECK(found.variance == Approx(1 - 2 / 3.14159265358979324).margin(errors * found.of_variance));
            const double within = (far_out <= 0.5).cast<double>().mean();
            CHECK(within == Approx(std::erf(0.5 / std::sqrt(2.0))).margin(2.5 * deviation));
            // The time has the arcsine law.
            for (const double t : {0.04, 0.25, 0.5, 0.9})
                CHECK((when <= t).cast<double>().mean() ==
                      Approx(2 / 3.14159265358979324 * std::asin(std::sqrt(t))).margin(2.5 * deviation));
            CHECK((far_out >= 0).all());
        }
        CHECK((e.accessory(wandering::highest) >= e.state(wandering::x)).all());
    }
    const auto e = wander(0.25, 0.8);
    const double below = normal(1 - 0.8) - std::exp(2 * 0.8) * normal(-1 - 0.8);
    CHECK((e.accessory(wandering::highest) <= 1).cast<double>().mean() == Approx(below).margin(2.5 * deviation));
    const double back = normal(1 + 0.8) - std::exp(-2 * 0.8) * normal(-1 + 0.8);
    CHECK((e.accessory(wandering::back) <= 2).cast<double>().mean() == Approx(back).margin(2.5 * deviation));
}
