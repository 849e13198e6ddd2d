// SPDX-License-Identifier: MIT
// The orders of methods for stochastic equations, against solutions that are functions of the path, and moments.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/support/device.hpp"
#include "tests/support/noisy.hpp"

namespace {

using noisy::sharing;
using noisy::solvable;

constexpr double end = 1, coarsest = 1.0 / 16, wide_start = 0.5;
constexpr int halvings = 5;  // steps 1/16 to 1/256
constexpr double finest = coarsest / (1 << (halvings - 1));

myriad::ensemble<solvable> start(std::int64_t paths, bool ito) {
    myriad::ensemble<solvable> e(paths);
    e.state(solvable::growth) = 1;
    e.state(solvable::wide) = wide_start;
    e.state(solvable::decay) = 1;
    e.parameter(solvable::ito) = ito ? 1 : 0;
    e.parameter(solvable::bare) = 0;
    e.time_domain(0, end);
    return e;
}
/// The Wiener processes at the end of the same paths.
myriad::ensemble<solvable> wiener(std::int64_t paths, std::int64_t seed, double cell = finest) {
    myriad::ensemble<solvable> e = start(paths, true);
    for (int c = 0; c < solvable::n_state; ++c) e.state(c) = 0;
    e.parameter(solvable::bare) = 1;
    myriad::solve<myriad::euler_maruyama>(tests::test_device(2), e, {.step = cell, .seed = seed});
    return e;
}

/// The slope of the line through (k, y[k]) by least squares.
double slope(const std::array<double, halvings>& y) {
    double above = 0, below = 0;
    for (int k = 0; k < halvings; ++k) {
        const double from_middle = k - (halvings - 1) / 2.0;
        above += from_middle * y[static_cast<std::size_t>(k)];
        below += from_middle * from_middle;
    }
    return above / below;
}

struct orders {
    double growth, wide;
};
/// The orders with which the paths of the equations with multiplicative noise converge in the mean: all steps follow
/// the same path, whose cells are the finest steps.
template <class Method>
orders strong_orders(bool ito, double largest = coarsest, std::int64_t paths = 4000) {
    constexpr std::int64_t seed = 3;
    const double cell = largest / (1 << (halvings - 1));
    const auto w = wiener(paths, seed, cell);
    const Eigen::ArrayXd growth = (solvable::rate * end + solvable::factor * w.state(solvable::growth)).exp();
    const Eigen::ArrayXd wide = (std::asinh(wide_start) + solvable::wideness * w.state(solvable::wide)).sinh();
    std::array<double, halvings> of_growth{}, of_wide{};
    for (int k = 0; k < halvings; ++k) {
        auto e = start(paths, ito);
        myriad::solve<Method>(tests::test_device(2), e, {.step = largest / (1 << k), .seed = seed, .noise_step = cell});
        of_growth[static_cast<std::size_t>(k)] = -std::log2((e.state(solvable::growth) - growth).abs().mean());
        of_wide[static_cast<std::size_t>(k)] = -std::log2((e.state(solvable::wide) - wide).abs().mean());
    }
    return {slope(of_growth), slope(of_wide)};
}

}  // namespace

TEST_CASE("euler_maruyama has strong order one half for Ito equations") {
    const orders found = strong_orders<myriad::euler_maruyama>(true);
    CHECK(found.growth == Approx(0.5).margin(0.05));
    CHECK(found.wide == Approx(0.5).margin(0.05));
}
TEST_CASE("linearly_implicit_euler_maruyama has strong order one half for Ito equations") {
    const orders found = strong_orders<myriad::linearly_implicit_euler_maruyama>(true);
    CHECK(found.growth == Approx(0.5).margin(0.05));
    CHECK(found.wide == Approx(0.5).margin(0.05));
}
TEST_CASE("milstein has strong order one for Ito equations") {
    const orders found = strong_orders<myriad::milstein>(true);
    CHECK(found.growth == Approx(1).margin(0.05));
    CHECK(found.wide == Approx(1).margin(0.05));
}
TEST_CASE("stochastic_heun has strong order one for Stratonovich equations") {
    const orders found = strong_orders<myriad::stochastic_heun>(false);
    CHECK(found.growth == Approx(1).margin(0.05));
    CHECK(found.wide == Approx(1).margin(0.05));
}

TEST_CASE("the Ito equation is solved in reversed time too: a martingale's mean does not depend on its noise") {
    const auto mean = [](auto method) {
        constexpr std::int64_t paths = 20'000;
        auto e = start(paths, true);
        e.time_domain(end, 0);
        myriad::solve<decltype(method)>(tests::test_device(2), e, {.step = 1.0 / 32, .seed = 3});
        return e.state(solvable::growth).mean();
    };
    // The deviation of x is its mean times sqrt(exp(0.64) - 1), which is below 0.95; the rest is of h.
    const double rate = solvable::rate + solvable::factor * solvable::factor / 2;
    const auto expected = Approx(std::exp(-rate * end)).epsilon(4 * 0.95 / std::sqrt(20'000.0) + 0.02);
    CHECK(mean(myriad::euler_maruyama()) == expected);
    CHECK(mean(myriad::milstein()) == expected);
    CHECK(mean(myriad::sriw1()) == expected);
}

/// The states at the end of the same paths for additive noise.
template <class Method>
myriad::ensemble<noisy::additive> with_additive_noise(std::int64_t paths, std::int64_t seed, double step) {
    using noisy::additive;
    myriad::ensemble<additive> e(paths);
    e.state(additive::x) = 0;
    e.state(additive::wave) = 0.1;
    e.time_domain(0, end);
    myriad::solve<Method>(tests::test_device(2), e, {.step = step, .seed = seed, .noise_step = finest});
    return e;
}
/// The orders with which paths converge for additive noise, of the equation with a linear drift (growth) and of the
/// other (wide).
template <class Method>
orders strong_orders_with_additive_noise() {
    using noisy::additive;
    constexpr std::int64_t paths = 2000, seed = 3;
    const auto w = wiener(paths, seed);
    const Eigen::ArrayXd exact =
        (additive::b * end + additive::a * additive::b * w.state(solvable::growth)) / std::sqrt(1 + end);
    // By sra1 with steps of a 16th of a cell, whose errors are 64 times less than those of the finest of its steps that
    // are compared.
    const auto of_reference = with_additive_noise<myriad::sra1>(paths, seed, finest / 16);
    const Eigen::ArrayXd reference = of_reference.state(additive::wave);
    std::array<double, halvings> linear{}, curved{};
    for (int k = 0; k < halvings; ++k) {
        const auto e = with_additive_noise<Method>(paths, seed, coarsest / (1 << k));
        linear[static_cast<std::size_t>(k)] = -std::log2((e.state(additive::x) - exact).abs().mean());
        curved[static_cast<std::size_t>(k)] = -std::log2((e.state(additive::wave) - reference).abs().mean());
    }
    return {slope(linear), slope(curved)};
}
TEST_CASE("sra1 has strong order three halves for additive noise, and two if the drift is linear") {
    const orders found = strong_orders_with_additive_noise<myriad::sra1>();
    CHECK(found.growth == Approx(2).margin(0.05));
    CHECK(found.wide == Approx(1.5).margin(0.05));
}
TEST_CASE("linearly_implicit_euler_maruyama has strong order one for additive noise") {
    const orders found = strong_orders_with_additive_noise<myriad::linearly_implicit_euler_maruyama>();
    CHECK(found.growth == Approx(1).margin(0.05));
    CHECK(found.wide == Approx(1).margin(0.05));
}

TEST_CASE("sriw1 has strong order three halves for Ito equations with diagonal noise") {
    const orders found = strong_orders<myriad::sriw1>(true, 1.0 / 64, 2000);  // longer ones are too long for it
    CHECK(found.growth == Approx(1.5).margin(0.05));
    CHECK(found.wide == Approx(1.5).margin(0.05));
}
TEST_CASE("sriw1 has strong order three halves where the drift joins states with noise of their own") {
    using noisy::coupled_drift;
    constexpr double largest = 1.0 / 32, cell = largest / 128;
    const auto at_end = [](double step) {
        myriad::ensemble<coupled_drift> e(1000);
        e.state(coupled_drift::x) = 0;
        e.state(coupled_drift::z) = 1;
        e.state(coupled_drift::cubic) = 0.3;
        e.time_domain(0, end);
        myriad::solve<myriad::sriw1>(tests::test_device(2), e, {.step = step, .seed = 3, .noise_step = cell});
        return e;
    };
    // An eighth of the finest steps that are compared, whose errors are 22 times larger.
    const auto reference = at_end(cell);
    std::array<double, halvings> joined{}, cubic{};
    for (int k = 0; k < halvings; ++k) {
        const auto e = at_end(largest / (1 << k));
        const auto error = [&](int state) {
            return -std::log2((e.state(state) - reference.state(state)).abs().mean());
        };
        joined[static_cast<std::size_t>(k)] = error(coupled_drift::z);
        cubic[static_cast<std::size_t>(k)] = error(coupled_drift::cubic);
    }
    CHECK(slope(joined) == Approx(1.5).margin(0.05));
    CHECK(slope(cubic) == Approx(1.5).margin(0.05));
}

TEST_CASE("euler_maruyama has weak order one where the noise does not commute") {
    // Differences between steps h and h / 2 along the same paths, whose spread is far below that of the values.
    constexpr std::int64_t paths = 200'000;
    std::array<double, 4> moment{};
    for (int k = 0; k < 4; ++k) {
        myriad::ensemble<sharing> e(paths);
        e.state(sharing::x) = 1;
        e.state(sharing::z) = 1;
        e.time_domain(0, 3);
        myriad::solve<myriad::euler_maruyama>(tests::test_device(2), e,
                                              {.step = 0.375 / (1 << k), .seed = 11, .noise_step = 0.375 / 8});
        moment[static_cast<std::size_t>(k)] = e.state(sharing::x).square().mean();
    }
    const double order = std::log2((moment[2] - moment[1]) / (moment[3] - moment[2]));
    CHECK(order == Approx(1).margin(0.05));
    // Extrapolated to h = 0, within four standard errors: the deviation of x^2 is some 1.1 times its mean.
    CHECK(2 * moment[3] - moment[2] == Approx(std::exp(-3.0)).epsilon(4 * 1.1 / std::sqrt(paths) + 0.004));
}

TEST_CASE("means by dri1 are those of the equation, and its paths are the same alone and among others") {
    constexpr std::int64_t paths = 100'000;
    const auto at_end = [](std::int64_t count) {
        myriad::ensemble<sharing> e(count);
        e.state(sharing::x) = 1;
        e.state(sharing::z) = 1;
        e.time_domain(0, 3);
        myriad::solve<myriad::dri1>(tests::test_device(2), e, {.step = 3.0 / 16, .seed = 11});
        return e;
    };
    const auto all = at_end(paths), alone = at_end(1);
    CHECK(all.state(sharing::x)[0] == alone.state(sharing::x)[0]);
    CHECK(all.state(sharing::z)[0] == alone.state(sharing::z)[0]);
    // Within four standard errors, and of x^2 what dri1_test's sums over all outcomes give for such steps.
    const auto& x = all.state(sharing::x);
    CHECK(x.square().mean() == Approx(std::exp(-3.0)).epsilon(4 * 1.1 / std::sqrt(paths) + 0.0015));
    CHECK(x.mean() == Approx(std::exp(-3 * 273.0 / 512)).margin(4 * std::sqrt(std::exp(-3.0) / paths)));
}

TEST_CASE("means and variances of an Ornstein-Uhlenbeck process are those of the method") {
    constexpr std::int64_t paths = 100'000;
    constexpr double h = 1.0 / 32, left = 1 - h * solvable::damping;
    auto e = start(paths, true);
    myriad::solve<myriad::euler_maruyama>(tests::test_device(2), e, {.step = h, .seed = 5});
    double mean = 1, variance = 0;
    for (int k = 0; k < 32; ++k) {
        mean *= left;
        variance = left * left * variance + h * solvable::force * solvable::force;
    }
    const auto& x = e.state(solvable::decay);
    const double found = x.mean(), spread = (x - found).square().sum() / (paths - 1);
    CHECK(found == Approx(mean).margin(4 * std::sqrt(variance / paths)));
    CHECK(spread == Approx(variance).epsilon(4 * std::sqrt(2.0 / paths)));
    // and those converge to the process's own
    CHECK(variance ==
          Approx(solvable::force * solvable::force / (2 * solvable::damping) * (1 - std::exp(-2 * solvable::damping)))
              .epsilon(0.03));
}

TEST_CASE("a stiff Ornstein-Uhlenbeck process has the stationary variance of linearly_implicit_euler_maruyama") {
    // x1 = (x + s dW) / (1 + h c) with h c = 100, whose variance is s^2 h / ((1 + h c)^2 - 1) after a few steps.
    constexpr std::int64_t paths = 100'000;
    constexpr double h = 100 / solvable::damping, factor = 1 + h * solvable::damping;
    auto e = start(paths, true);
    e.time_domain(0, 4 * h);
    myriad::solve<myriad::linearly_implicit_euler_maruyama>(tests::test_device(2), e, {.step = h, .seed = 5});
    const double variance = h * solvable::force * solvable::force / (factor * factor - 1);
    const auto& x = e.state(solvable::decay);
    const double found = x.mean(), spread = (x - found).square().sum() / (paths - 1);
    CHECK(found == Approx(0).margin(4 * std::sqrt(variance / paths)));
    CHECK(spread == Approx(variance).epsilon(4 * std::sqrt(2.0 / paths)));
}
