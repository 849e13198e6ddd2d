// SPDX-License-Identifier: MIT
// Adaptive steps of stochastic equations: errors by tolerances, no bias by rejections, and the same bits in any order.
#include "myriad/kernel/controller/adaptive_on_path.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/support/device.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/noisy.hpp"

namespace {

using Catch::Matchers::Contains;
using noisy::quadratic;
using noisy::solvable;
using sriw1 = myriad::adaptive<myriad::sriw1>;
using sra1 = myriad::adaptive<myriad::sra1>;

template <class R = double>
myriad::ensemble<solvable, R> start(std::int64_t paths, R t_end = 1) {
    myriad::ensemble<solvable, R> e(paths);
    e.state(solvable::growth) = R(1);
    e.state(solvable::wide) = R(0.5);
    e.state(solvable::decay) = R(1);
    e.parameter(solvable::ito) = R(1);
    e.parameter(solvable::bare) = R(0);
    e.time_domain(0, t_end);
    return e;
}
/// The processes at 1 on paths with such cells.
Eigen::ArrayXd wiener(int process, std::int64_t paths, double cell) {
    auto e = start(paths);
    for (int c = 0; c < solvable::n_state; ++c) e.state(c) = 0;
    e.parameter(solvable::bare) = 1;
    myriad::solve<myriad::euler_maruyama>(tests::test_device(2), e, {.step = cell, .seed = 3});
    return e.state(process);
}
myriad::options within(double tolerance, double cell = 0.25) {
    return {.relative_tolerance = tolerance, .absolute_tolerance = tolerance, .seed = 3, .noise_step = cell};
}
Eigen::ArrayXd exact_growth(std::int64_t paths) {
    return (solvable::rate + solvable::factor * wiener(solvable::growth, paths, 0.25)).exp();
}

myriad::ensemble<quadratic> stiff(std::int64_t paths) {
    myriad::ensemble<quadratic> e(paths);
    e.state(quadratic::x) = 0.5;
    e.parameter(quadratic::a) = 1;
    e.parameter(quadratic::b) = 2.5;
    e.time_domain(0, 1);
    return e;
}

template <class Model, class R>
std::int64_t differences(const myriad::ensemble<Model, R>& all, const myriad::ensemble<Model, R>& some,
                         std::int64_t shift = 0) {
    std::int64_t different = 0;
    for (int c = 0; c < Model::n_state; ++c)
        different += std::memcmp(all.state(c).data() + shift, some.state(c).data(),
                                 sizeof(R) * static_cast<std::size_t>(some.size())) != 0;
    return different;
}

}  // namespace

TEST_CASE("errors of adaptive paths follow the tolerance, with the steps that a stiff problem needs") {
    constexpr std::int64_t paths = 400;
    const Eigen::ArrayXd growth = exact_growth(paths);
    const Eigen::ArrayXd x = (std::atanh(0.5) - 1 + 2.5 * wiener(0, paths, 0.25)).tanh();
    double growth_before = 1, x_before = 1;
    for (const double tolerance : {1e-3, 1e-4, 1e-5}) {
        INFO("tolerance " << tolerance);
        auto e = start(paths);
        myriad::solve<sriw1>(tests::test_device(2), e, within(tolerance));
        const double growth_error = (e.state(solvable::growth) - growth).abs().mean();
        auto q = stiff(paths);
        myriad::solve<sriw1>(tests::test_device(2), q, within(tolerance));
        const double x_error = (q.state(quadratic::x) - x).abs().mean();
        CHECK(growth_error < 5 * tolerance);  // errors of some hundred steps, of which each is within the tolerance
        CHECK(x_error < 60 * tolerance);      // and of some thousand, as they grow in between
        CHECK(growth_error < growth_before / 3);
        CHECK(x_error < x_before / 3);
        growth_before = growth_error;
        x_before = x_error;
    }
}

TEST_CASE("means and variances have no bias although many steps are rejected") {
    constexpr std::int64_t paths = 40'000;
    auto e = start(paths);
    const auto report = myriad::solve<sriw1>(tests::test_device(2), e, within(3e-3, 1));
    CHECK(report.rejected_steps > paths);
    const auto mean = [](const Eigen::ArrayXd& a) { return a.mean(); };
    const auto error = [&](const Eigen::ArrayXd& a) {
        return std::sqrt((a - a.mean()).square().sum() / (paths - 1.0) / paths);
    };
    const auto& g = e.state(solvable::growth);
    const double rate = solvable::rate + solvable::factor * solvable::factor / 2;
    CHECK(mean(g) == Approx(std::exp(rate)).margin(4 * error(g)));
    CHECK(mean(g.log()) == Approx(solvable::rate).margin(4 * error(g.log())));
    const Eigen::ArrayXd& x = e.state(solvable::decay);
    const double of_mean = std::exp(-solvable::damping);
    const double variance = solvable::force * solvable::force / (2 * solvable::damping) * (1 - of_mean * of_mean);
    CHECK(mean(x) == Approx(of_mean).margin(4 * error(x)));
    CHECK(mean((x - of_mean).square()) == Approx(variance).margin(4 * error((x - of_mean).square())));
}
TEST_CASE("errors of adaptive paths average out as those of fixed steps do, although steps are chosen and rejected") {
    constexpr std::int64_t paths = 4000;
    auto e = start(paths);
    myriad::solve<sriw1>(tests::test_device(2), e, within(1e-3));
    const Eigen::ArrayXd of_growth = e.state(solvable::growth) - exact_growth(paths);
    CHECK(std::fabs(of_growth.mean()) < 0.1 * of_growth.abs().mean());
    auto q = stiff(paths);
    const auto report = myriad::solve<sriw1>(tests::test_device(2), q, within(1e-3));
    const Eigen::ArrayXd of_x = q.state(quadratic::x) - (std::atanh(0.5) - 1 + 2.5 * wiener(0, paths, 0.25)).tanh();
    CHECK(report.rejected_steps > report.accepted_steps / 20);
    CHECK(std::fabs(of_x.mean()) < 0.2 * of_x.abs().mean());
}

TEST_CASE("a path with adaptive steps has the same bits alone, among others, in a chunk and by any number of threads") {
    const myriad::options o = within(1e-3);
    auto all = start(101);
    myriad::solve<sriw1>(tests::test_device(1), all, o);
    auto again = start(101);
    auto dynamic = o;
    dynamic.schedule = myriad::schedule::dynamic;
    myriad::solve<sriw1>(tests::test_device(3), again, dynamic);
    CHECK(differences(all, again) == 0);
    for (const std::int64_t first : {1, 50, 96}) {
        auto chunk = start(5);
        myriad::host::ensemble_access::data(chunk).first_index = first;
        myriad::solve<sriw1>(tests::test_device(1), chunk, o);
        CHECK(differences(all, chunk, first) == 0);
    }
    auto single = start<float>(33);
    myriad::solve<sriw1>(tests::test_device(2), single, within(1e-2));
    auto alone = start<float>(1);
    myriad::host::ensemble_access::data(alone).first_index = 17;
    myriad::solve<sriw1>(tests::test_device(1), alone, within(1e-2));
    CHECK(differences(single, alone, 17) == 0);
    auto fine = start<float>(33);
    myriad::solve<myriad::milstein>(tests::test_device(2), fine, {.step = 0.25 / 1024, .seed = 3, .noise_step = 0.25});
    CHECK((single.state(solvable::growth) - fine.state(solvable::growth)).abs().mean() < 0.02F);
}

TEST_CASE("adaptive steps follow the path of fixed ones, forwards and backwards, in phases and past stops") {
    constexpr std::int64_t paths = 50;
    const auto fixed = [](bool backwards) {
        auto e = start(paths);
        if (backwards) e.time_domain(1, 0);
        myriad::solve<myriad::sriw1>(tests::test_device(), e, {.step = 1.0 / 2048, .seed = 3, .noise_step = 0.25});
        return e;
    };
    for (const bool backwards : {false, true}) {
        INFO("backwards " << backwards);
        const auto reference = fixed(backwards);
        auto e = start(paths);
        if (backwards) e.time_domain(1, 0);
        myriad::solve<sriw1>(tests::test_device(), e, within(1e-4));
        CHECK((e.state(solvable::growth) - reference.state(solvable::growth)).abs().maxCoeff() < 3e-3);
        CHECK((e.state(solvable::decay) - reference.state(solvable::decay)).abs().maxCoeff() < 3e-4);
    }
    const auto reference = fixed(false);
    auto in_phases = start(paths);
    auto o = within(1e-4);
    o.phases = 8;
    o.phase_length = 0.13;  // which ends no step
    myriad::solve<sriw1>(tests::test_device(), in_phases, o);
    CHECK((in_phases.state(solvable::growth) - reference.state(solvable::growth)).abs().maxCoeff() < 3e-3);

    myriad::ensemble<noisy::interrupted> e(paths);
    e.state(solvable::growth) = 1;
    e.state(solvable::wide) = 0.5;
    e.state(solvable::decay) = 1;
    e.parameter(solvable::ito) = 1;
    e.parameter(solvable::bare) = 0;
    e.accessory(noisy::interrupted::interval) = Eigen::ArrayXd::LinSpaced(paths, 0.03, 0.4);
    e.accessory(noisy::interrupted::steps) = 0;
    e.time_domain(0, 1);
    myriad::solve<sriw1>(tests::test_device(), e, within(1e-4));
    CHECK((e.state(solvable::growth) - reference.state(solvable::growth)).abs().maxCoeff() < 5e-3);
    CHECK((e.state(solvable::decay) - reference.state(solvable::decay)).minCoeff() > 0.3);  // of what stops add
}

TEST_CASE("sra1 with adaptive steps follows the tolerance for additive noise, by the cells of the domain too") {
    using noisy::additive;
    constexpr std::int64_t paths = 200;
    const auto at_end = [](auto method, const myriad::options& o) {
        myriad::ensemble<additive> e(paths);
        e.state(additive::x) = 0;
        e.state(additive::wave) = 0.1;
        e.time_domain(0, 1);
        myriad::solve<decltype(method)>(tests::test_device(2), e, o);
        return e;
    };
    const auto reference = at_end(myriad::sra1(), {.step = 1.0 / 4096, .seed = 3, .noise_step = 1.0 / 64});
    for (const double tolerance : {1e-3, 1e-5}) {
        INFO("tolerance " << tolerance);
        auto o = within(tolerance);
        o.noise_step = 0;  // a 64th of the domain
        const auto e = at_end(sra1(), o);
        CHECK((e.state(additive::wave) - reference.state(additive::wave)).abs().mean() < 10 * tolerance);
        CHECK((e.state(additive::x) - reference.state(additive::x)).abs().mean() < 10 * tolerance);
    }
}

TEST_CASE("steps of the same lengths are carried on, and longest and shortest ones are kept") {
    auto e = start(20);
    auto o = within(1e-2);
    o.maximum_step = 0.02;  // 1/64
    const auto report = myriad::solve<sriw1>(tests::test_device(), e, o);
    CHECK(report.accepted_steps >= 20 * 64);
    CHECK(report.rejected_steps < report.accepted_steps / 4);
    auto short_of = start(20);
    o = within(1e-6);
    o.minimum_step = 0.05;
    myriad::solve<sriw1>(tests::test_device(), short_of, o);
    CHECK(short_of.statuses()[3] == myriad::status::step_underflow);
}

TEST_CASE("what adaptive steps of paths cannot do is said before any work") {
    auto e = start(2);
    const auto message = [&](const myriad::options& o) {
        return tests::message_of([&] { myriad::solve<sriw1>(tests::test_device(), e, o); });
    };
    auto o = within(1e-2);
    o.maximum_step = 1e-6;
    CHECK_THAT(message(o), Contains("maximum_step is 1e-06, less than a 65536th of noise_step, 0.25"));
    e.t_end()(1) = 2;
    o = within(1e-2);
    o.noise_step = 0;
    CHECK_THAT(message(o), Contains("noise_step is not set, and instances have domains of their own"));
}
