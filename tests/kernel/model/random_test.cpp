// SPDX-License-Identifier: MIT
// Random numbers of hooks: published answers, the shape of their distributions, and the same bits on host and device.
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/kernel/model/random_draws.hpp"
#include "tests/support/device.hpp"

namespace {

using myriad::philox_4x32_10;
using myriad::random_block;
using myriad::random_numbers;
using random_draws::draws;

constexpr bool same(const random_block& a, const random_block& b) {
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2] && a[3] == b[3];
}

constexpr int side = 16, bins = side * side;
constexpr std::int64_t samples = 1 << 18;

/// Pearson's statistic of pairs (first(i), second(i)) in 16 x 16 equal parts of the unit square: chi-square with 255
/// degrees of freedom if both are uniform and independent, with some 1000 pairs in each part.
template <class First, class Second>
double chi_square(First&& first, Second&& second) {
    std::array<std::int64_t, bins> found{};
    for (std::int64_t i = 0; i < samples; ++i)
        ++found[static_cast<std::size_t>(side * static_cast<int>(side * first(i)) +
                                         static_cast<int>(side * second(i)))];
    const double expected = static_cast<double>(samples) / bins;
    double sum = 0;
    for (const std::int64_t n : found) sum += std::pow(static_cast<double>(n) - expected, 2) / expected;
    return sum;
}

/// Within the quantiles 1e-5 and 1 - 1e-5 of that distribution. The seeds are fixed, and so is the outcome.
bool is_likely(double statistic) { return statistic > 169.9 && statistic < 363.0; }

/// Draw number n of an instance in a phase.
double draw(std::uint64_t seed, std::int64_t index, std::int32_t phase, std::uint32_t n) {
    return random_numbers<double>(seed, index, phase, n).uniform();
}

/// The normal distribution's inverse by Newton's method on the error function in long double; `start` is close already.
long double precise_quantile(long double p, long double start) {
    const bool lower = p < 0.5L;
    const long double tail = lower ? p : 1 - p, centre = p - 0.5L;
    long double x = start;
    for (int k = 0; k < 4; ++k) {
        const long double density = std::exp(-x * x / 2) / std::sqrt(2 * std::acos(-1.0L));
        if (std::fabs(centre) < 0.25L) {
            x -= (std::erf(x / std::sqrt(2.0L)) / 2 - centre) / density;
        } else {
            const long double beyond = std::erfc(std::fabs(x) / std::sqrt(2.0L)) / 2;
            x += (lower ? -1 : 1) * (beyond - tail) / density;
        }
    }
    return x;
}

template <class R>
double relative_error(R p) {
    const R x = myriad::normal_quantile(p);
    const long double truth = precise_quantile(static_cast<long double>(p), static_cast<long double>(x));
    return static_cast<double>(std::fabs((static_cast<long double>(x) - truth) / truth));
}

}  // namespace

TEST_CASE("philox_4x32_10 gives the known answers of Random123") {
    // Its file tests/kat_vectors, lines "philox4x32 10": counter, key, answer.
    STATIC_REQUIRE(same(philox_4x32_10({0, 0, 0, 0}, 0), {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
    constexpr std::uint32_t ones = 0xffffffff;
    STATIC_REQUIRE(same(philox_4x32_10({ones, ones, ones, ones}, 0xffffffffffffffff),
                        {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
    STATIC_REQUIRE(same(philox_4x32_10({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, 0x299f31d0a4093822),
                        {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST_CASE("the counter of a draw is index, phase and number, and the key the seed") {
    random_numbers<double> random(0x299f31d0a4093822, static_cast<std::int64_t>(0x85a308d3'243f6a88), 0x13198a2e,
                                  0x03707344);
    CHECK(same(random.next(), {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
    CHECK(same(random.next(), philox_4x32_10({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707345}, 0x299f31d0a4093822)));
}

TEST_CASE("a uniform number is the middle of its part of (0, 1), never 0 or 1") {
    using myriad::uniform_of;
    constexpr random_block least{0, 0, 0, 0}, most{0xffffffff, 0xffffffff, 0, 0}, second{0x00001000, 0, 0, 0},
        float_second{0, 0x200, 0, 0};
    STATIC_REQUIRE(uniform_of<double>(least) == 0x1p-53);
    STATIC_REQUIRE(uniform_of<double>(second) == 0x3p-53);
    STATIC_REQUIRE(uniform_of<double>(most) == 1 - 0x1p-53);
    STATIC_REQUIRE(uniform_of<float>(least) == 0x1p-24f);
    STATIC_REQUIRE(uniform_of<float>(float_second) == 0x3p-24f);
    STATIC_REQUIRE(uniform_of<float>(most) == 1 - 0x1p-24f);
}

TEST_CASE("pairs of draws that differ in one part of the counter are uniform and independent") {
    const auto by_index = [](std::int64_t i) { return draw(7, i, 0, 0); };
    CHECK(is_likely(chi_square(by_index, [](std::int64_t i) { return draw(7, i + 1, 0, 0); })));
    CHECK(is_likely(chi_square(by_index, [](std::int64_t i) { return draw(7, i + (std::int64_t{1} << 32), 0, 0); })));
    CHECK(is_likely(chi_square(by_index, [](std::int64_t i) { return draw(7, i, 1, 0); })));
    CHECK(is_likely(chi_square(by_index, [](std::int64_t i) { return draw(7, i, 0, 1); })));
    CHECK(is_likely(chi_square(by_index, [](std::int64_t i) { return draw(8, i, 0, 0); })));
    const auto by_number = [](std::int64_t i) { return draw(7, 3, 0, static_cast<std::uint32_t>(2 * i)); };
    CHECK(is_likely(
        chi_square(by_number, [](std::int64_t i) { return draw(7, 3, 0, static_cast<std::uint32_t>(2 * i + 1)); })));
    const auto of_normal = [](std::int64_t i) {
        return 0.5 * std::erfc(-random_numbers<double>(7, i, 0).normal() / std::sqrt(2.0));
    };
    CHECK(is_likely(chi_square(of_normal, [](std::int64_t i) { return draw(7, i, 0, 1); })));
}

TEST_CASE("the check of pairs refuses what is too even, shifted, or depends on its neighbour") {
    const auto good = [](std::int64_t i) { return draw(7, i, 0, 0); };
    const auto shifted = [&](std::int64_t i) { return 0.98 * good(i); };
    const auto even = [](std::int64_t i) { return (static_cast<double>(i % 4096) + 0.5) / 4096; };
    const auto slow = [](std::int64_t i) { return (static_cast<double>(i / 4096) + 0.5) / 64; };
    const auto dependent = [&](std::int64_t i) { return std::fmod(good(i) + 0.8 * draw(7, i, 0, 1), 1.0); };
    CHECK_FALSE(is_likely(chi_square(good, shifted)));
    CHECK_FALSE(is_likely(chi_square(even, slow)));
    CHECK_FALSE(is_likely(chi_square(good, dependent)));
}

TEST_CASE("normal_quantile errs by 1e-15 in double and 1e-6 in single precision") {
    // The approximation's own error is about 1e-16; rounding adds an ulp in each of p's parts, numerator, denominator
    // and logarithm. 16 ulps in single precision are the same allowance.
    double worst = 0, worst_float = 0;
    for (std::int64_t i = 0; i < 50'000; ++i) {
        const double u = draw(1, i, 0, 0);
        const double p = i % 2 == 0 ? u : std::ldexp(u, -static_cast<int>(i % 100) / 2);
        worst = std::fmax(worst, relative_error(p));
        worst_float = std::fmax(worst_float, relative_error(random_numbers<float>(1, i, 0).uniform()));
    }
    CAPTURE(worst, worst_float);
    CHECK(worst < 1e-15);
    CHECK(worst_float < 1e-6);
    CHECK(myriad::normal_quantile(0x1p-53) == -myriad::normal_quantile(1 - 0x1p-53));
    CHECK(relative_error(0x1p-53) < 1e-15);
}

TEMPLATE_TEST_CASE("normal_quantile is infinite at 0 and at 1, finite next to them, and no number beyond", "", double,
                   float) {
    using R = TestType;
    using limits = std::numeric_limits<R>;
    CHECK(myriad::normal_quantile(R(0)) == -limits::infinity());
    CHECK(myriad::normal_quantile(R(-0.0)) == -limits::infinity());
    CHECK(myriad::normal_quantile(R(1)) == limits::infinity());
    CHECK(std::isfinite(myriad::normal_quantile(limits::min())));
    CHECK(std::isfinite(myriad::normal_quantile(1 - limits::epsilon() / 2)));
    for (const R beyond : {-limits::min(), R(-1), 1 + limits::epsilon(), limits::infinity(), limits::quiet_NaN()})
        CHECK(std::isnan(myriad::normal_quantile(beyond)));
}

TEMPLATE_TEST_CASE("instances from number 2^31 on draw numbers of their own", "", double, float) {
    using R = TestType;
    constexpr std::int32_t seed = 7;
    for (const std::int64_t first :
         {(std::int64_t{1} << 31) - 50, (std::int64_t{1} << 32) - 50, std::int64_t{1} << 52}) {
        myriad::ensemble<draws, R> all(100);
        myriad::host::ensemble_access::data(all).first_index = first;  // as in a chunk of a study
        all.state(draws::unused) = R(0);
        all.shared_integer(draws::seed) = seed;
        all.time_domain(0, R(0.01));
        myriad::solve<myriad::runge_kutta_4>(tests::test_device(), all, {.step = 0.01});
        std::int64_t different = 0;
        for (std::int64_t i = 0; i < all.size(); ++i)
            different += all.accessory(draws::uniform)[i] != random_numbers<R>(seed, first + i, 0).uniform();
        CHECK(different == 0);
    }
}

TEMPLATE_TEST_CASE("hooks draw the same bits as the host, in every phase and by every schedule", "", double, float) {
    using R = TestType;
    constexpr std::int32_t seed = 20'111'118, phases = 3;
    for (const auto how : {myriad::schedule::in_order, myriad::schedule::dynamic}) {
        myriad::ensemble<draws, R> all(3001);
        all.state(draws::unused) = R(0);
        all.shared_integer(draws::seed) = seed;
        all.time_domain(0, R(0.01));
        const auto report = myriad::solve<myriad::runge_kutta_4>(
            tests::test_device(2), all,
            {.phases = phases,
             .step = 0.01,
             .record = {.accessories = {draws::uniform, draws::between, draws::normal, draws::scaled,
                                        draws::at_the_end}},
             .schedule = how});
        std::int64_t different = 0;
        for (std::int64_t i = 0; i < all.size(); ++i)
            for (std::int32_t phase = 0; phase < phases; ++phase) {
                random_numbers<R> random(seed, i, phase);
                const auto drawn = [&](int a) { return report.records.accessory(a)(i, phase); };
                different += drawn(draws::uniform) != random.uniform();
                different += drawn(draws::between) != random.uniform(R(-3), R(5));
                different += drawn(draws::normal) != random.normal();
                different += drawn(draws::scaled) != random.normal(R(10), R(3));
                different += drawn(draws::at_the_end) != random.normal();
            }
        CHECK(different == 0);
    }
}
