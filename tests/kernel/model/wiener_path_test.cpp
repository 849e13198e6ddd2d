// SPDX-License-Identifier: MIT
// Paths of Wiener processes: the distribution of their increments, the same values whatever the steps, in packs and in
// plain lanes, and places on a path as whole numbers.

#include "myriad/kernel/model/wiener_path.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <type_traits>
#include <vector>

#include "myriad/kernel/model/random.hpp"
#include "myriad/kernel/scalar/pack.hpp"
#include "tests/catch.hpp"

namespace {

using myriad::detail::get_lane;
using myriad::detail::parts_of_cell;
using myriad::detail::path_constants_of;
using myriad::detail::path_interval;
using myriad::detail::path_owner;
using myriad::detail::path_place;
using myriad::detail::set_lane;

template <class R>
path_interval<R> interval(path_place<R> from, path_place<R> to, std::int64_t instance, std::int32_t epoch = 0,
                          std::uint64_t seed = 1) {
    static std::map<std::uint64_t, myriad::detail::path_constants<R>> of_seed;
    path_interval<R> over{from, to, {}, &of_seed.try_emplace(seed, path_constants_of(R(1), seed)).first->second};
    over.of.set(0, instance, epoch);
    return over;
}

/// The increment of one process over a cell.
template <class R, int processes>
myriad::vec<R, processes> over_cell(std::int64_t cell, std::int64_t instance, std::int32_t epoch = 0,
                                    std::uint64_t seed = 1) {
    using number = typename myriad::detail::path_integers<R>::cell;
    const auto at = static_cast<number>(cell);
    return myriad::detail::path_increments<processes>(
        interval<R>({at, 0}, {static_cast<number>(at + 1), 0}, instance, epoch, seed));
}

template <class R>
std::vector<double> draws(int count) {
    std::vector<double> all;
    all.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count / 4; ++i) {
        const auto dw = over_cell<R, 4>(i % 64, i / 64);
        for (int k = 0; k < 4; ++k) all.push_back(static_cast<double>(dw[k]));
    }
    return all;
}

/// The correlation of pairs of unit variance, in standard deviations of its estimate.
template <class First, class Second>
double correlation(int pairs, First&& first, Second&& second) {
    double sum = 0;
    for (int i = 0; i < pairs; ++i) sum += first(i) * second(i);
    return sum / std::sqrt(pairs);
}

}  // namespace

TEMPLATE_TEST_CASE("increments have the moments of the normal distribution", "", double, float) {
    const int count = 1 << 20;
    double mean = 0, square = 0, cube = 0, fourth = 0;
    for (const double z : draws<TestType>(count)) {
        mean += z, square += z * z, cube += z * z * z, fourth += z * z * z * z;
    }
    // Four standard deviations of each mean: the variances of z, z^2, z^3 and z^4 are 1, 2, 15 and 96.
    const double bound = 4 / std::sqrt(count);
    CHECK(std::fabs(mean / count) < bound);
    CHECK(std::fabs(square / count - 1) < bound * std::sqrt(2.0));
    CHECK(std::fabs(cube / count) < bound * std::sqrt(15.0));
    CHECK(std::fabs(fourth / count - 3) < bound * std::sqrt(96.0));
}

TEMPLATE_TEST_CASE("increments pass the test of Kolmogorov and Smirnov against the normal distribution", "", double,
                   float) {
    std::vector<double> z = draws<TestType>(1 << 18);
    std::sort(z.begin(), z.end());
    const auto count = static_cast<double>(z.size());
    double largest = 0;
    for (std::size_t i = 0; i < z.size(); ++i) {
        const double below = 0.5 * std::erfc(-z[i] / std::sqrt(2.0));
        largest = std::max({largest, std::fabs(below - static_cast<double>(i) / count),
                            std::fabs(below - static_cast<double>(i + 1) / count)});
    }
    CHECK(largest * std::sqrt(count) < 1.95);  // exceeded with probability 0.001
}

TEMPLATE_TEST_CASE("instances, processes, cells, phases, seeds and the halves of a cell are not correlated", "", double,
                   float) {
    using R = TestType;
    const int pairs = 1 << 16;
    const auto of = [](std::int64_t cell, std::int64_t instance, int process, std::int32_t epoch = 0,
                       std::uint64_t seed = 1) {
        return static_cast<double>(over_cell<R, 9>(cell, instance, epoch, seed)[process]);
    };
    const auto here = [&](int i) { return of(i % 256, i / 256, 0); };
    CHECK(std::fabs(correlation(pairs, here, [&](int i) { return of(i % 256, i / 256 + 1, 0); })) < 4);
    CHECK(std::fabs(correlation(pairs, here, [&](int i) { return of(i % 256 + 1, i / 256, 0); })) < 4);
    CHECK(std::fabs(correlation(pairs, here, [&](int i) { return of(-1 - i % 256, i / 256, 0); })) < 4);
    CHECK(std::fabs(correlation(pairs, here, [&](int i) { return of(i % 256, i / 256, 0, 1); })) < 4);
    CHECK(std::fabs(correlation(pairs, here, [&](int i) { return of(i % 256, i / 256, 0, 0, 2); })) < 4);
    for (int process = 1; process < 9; ++process)
        CHECK(std::fabs(correlation(pairs, here, [&](int i) { return of(i % 256, i / 256, process); })) < 4);
    // of the same instance and cell, scaled to unit variance
    const auto half = [&](int i, int which) {
        const auto cell = static_cast<typename myriad::detail::path_integers<R>::cell>(i % 256);
        const path_place<R> begin{cell, 0}, middle{cell, parts_of_cell / 2}, end{cell + 1, 0};
        const auto over = which == 0 ? interval<R>(begin, middle, i / 256) : interval<R>(middle, end, i / 256);
        return static_cast<double>(myriad::detail::path_increments<1>(over)[0]) * std::sqrt(2.0);
    };
    CHECK(std::fabs(correlation(
              pairs, [&](int i) { return half(i, 0); }, [&](int i) { return half(i, 1); })) < 4);
    double square = 0;
    for (int i = 0; i < pairs; ++i) square += half(i, 0) * half(i, 0);
    CHECK(std::fabs(square / pairs - 1) < 4 * std::sqrt(2.0 / pairs));
}

TEMPLATE_TEST_CASE("the eighths of a cell have variances of an eighth, and no correlation", "", double, float) {
    using R = TestType;
    constexpr int count = 1 << 14, eighths = 8;
    double product[eighths][eighths]{};
    for (int i = 0; i < count; ++i) {
        double dw[eighths];
        for (int k = 0; k < eighths; ++k) {
            const path_place<R> begin{0, k * (parts_of_cell / eighths)};
            const auto over = interval<R>(begin, myriad::detail::moved(begin, {0, parts_of_cell / eighths}), i);
            dw[k] = static_cast<double>(myriad::detail::path_increments<1>(over)[0]) * std::sqrt(double{eighths});
        }
        for (int k = 0; k < eighths; ++k)
            for (int j = 0; j <= k; ++j) product[k][j] += dw[k] * dw[j];
    }
    // Within four standard deviations.
    for (int k = 0; k < eighths; ++k)
        for (int j = 0; j <= k; ++j)
            CHECK(std::fabs(product[k][j] / count - (k == j ? 1 : 0)) < 4 * std::sqrt((k == j ? 2.0 : 1.0) / count));
}

TEMPLATE_TEST_CASE("instances that differ in their high words, far cells and phases have paths of their own", "",
                   double, float) {
    using R = TestType;
    const std::int64_t far = std::is_same_v<R, double> ? std::int64_t{1} << 38 : std::int64_t{1} << 30;
    std::vector<double> first;
    for (const std::int64_t instance : {std::int64_t{0}, std::int64_t{1} << 32, std::int64_t{15} << 32})
        for (const std::int64_t cell : {std::int64_t{0}, far, -far, std::int64_t{-1}})
            for (const std::int32_t epoch : {0, 1, 1 << 20})
                first.push_back(static_cast<double>(over_cell<R, 1>(cell, instance, epoch)[0]));
    std::sort(first.begin(), first.end());
    CHECK(std::adjacent_find(first.begin(), first.end()) == first.end());
}

TEMPLATE_TEST_CASE("increments over parts, in whatever division, add up to those over the whole", "", double, float) {
    using R = TestType;
    using number = typename myriad::detail::path_integers<R>::cell;
    constexpr int count = 5;
    const auto place = [](std::int64_t parts) {
        const std::int64_t cell = parts >= 0 ? parts / parts_of_cell : -((parts_of_cell - 1 - parts) / parts_of_cell);
        return path_place<R>{static_cast<number>(cell), static_cast<std::int32_t>(parts - cell * parts_of_cell)};
    };
    const std::int64_t begin = -parts_of_cell - 12'345, end = 3 * parts_of_cell + 777;
    const auto whole = myriad::detail::path_increments<count>(interval<R>(place(begin), place(end), 42));
    const auto back = myriad::detail::path_increments<count>(interval<R>(place(end), place(begin), 42));
    for (const std::int64_t length : {4096, 10'000, 32'768, 65'536, 100'000}) {
        double sum[count]{};
        for (std::int64_t at = begin; at < end; at += length) {
            const auto dw =
                myriad::detail::path_increments<count>(interval<R>(place(at), place(std::min(at + length, end)), 42));
            for (int k = 0; k < count; ++k) sum[k] += static_cast<double>(dw[k]);
        }
        for (int k = 0; k < count; ++k)  // some 100 values near one, each rounded
            CHECK(sum[k] == Approx(static_cast<double>(whole[k])).margin(200.0 * myriad::epsilon_of<R>));
    }
    for (int k = 0; k < count; ++k)
        CHECK(static_cast<double>(back[k]) ==
              Approx(-static_cast<double>(whole[k])).margin(20.0 * myriad::epsilon_of<R>));
}

TEMPLATE_TEST_CASE("a path has the same bits in a plain lane and in packs, whatever the other lanes do", "",
                   (myriad::pack<double, 1>), (myriad::pack<float, 2>)) {
    using S = TestType;
    using R = myriad::real_of<S>;
    using number = typename myriad::detail::path_integers<R>::cell;
    constexpr int lanes = S::lanes, count = 5;
    std::int64_t different = 0;
    for (int kind = 0; kind < 3; ++kind) {  // all over one cell, some over more or over parts, all over parts
        path_interval<S> over{};
        const auto constants = path_constants_of(R(0.25), 1);
        over.constants = &constants;
        path_interval<R> alone[lanes];
        for (int i = 0; i < lanes; ++i) {
            const bool parts = kind == 2 || (kind == 1 && i % 3 == 1), many = kind == 1 && i % 3 == 2;
            const path_place<R> from{static_cast<number>(7 * i - 20), parts ? 1024 * i : 0};
            const path_place<R> length{static_cast<number>(many ? i : parts ? 0 : 1), parts ? parts_of_cell / 4 : 0};
            alone[i] = {from, myriad::detail::moved(from, length), {}, over.constants};
            const std::int64_t instance = (std::int64_t{1} << 33) + 1000 * i;
            alone[i].of.set(0, instance, i);
            over.of.set(i, instance, i);
            myriad::detail::set_place(over.from, i, alone[i].from);
            myriad::detail::set_place(over.to, i, alone[i].to);
        }
        const auto together = myriad::detail::path_increments<count>(over);
        for (int i = 0; i < lanes; ++i) {
            const auto own = myriad::detail::path_increments<count>(alone[i]);
            for (int k = 0; k < count; ++k) {
                const R a = get_lane(together[k], i), b = own[k];
                different += std::memcmp(&a, &b, sizeof a) != 0;
            }
        }
    }
    CHECK(different == 0);
}

TEST_CASE("blocks of a path are those of Philox at its counters") {
    std::uint32_t words[4] = {1, 2, 3, 4};
    myriad::detail::philox_of_words<double>(words, {5, 6});
    const auto expected = myriad::philox_4x32_10({1, 2, 3, 4}, std::uint64_t{6} << 32 | 5);
    for (int i = 0; i < 4; ++i) CHECK(words[i] == expected[i]);
}

TEMPLATE_TEST_CASE("a length is whole cells where it is that up to rounding, and else the nearest part", "", double,
                   float) {
    using R = TestType;
    using myriad::detail::place_of_length;
    const R cell = R(0.01);
    for (const int cells : {0, 1, 3, 1000, 100'000, -1, -250}) {
        const auto found = place_of_length(static_cast<R>(cells) * cell, cell);
        CHECK(found.cell == cells);
        CHECK(found.part == 0);
    }
    const auto half = place_of_length(R(0.5) * cell, cell), before = place_of_length(R(-0.25) * cell, cell);
    CHECK(half.cell == 0);
    CHECK(half.part == parts_of_cell / 2);
    CHECK(before.cell == -1);
    CHECK(before.part == 3 * (parts_of_cell / 4));
    const auto third = place_of_length(cell / R(3), cell);
    CHECK(third.part == 21845);
    // Whole numbers do not drift.
    path_place<R> at{0, 0};
    for (int i = 0; i < 1000; ++i) at = myriad::detail::moved(at, before);
    CHECK(at.cell == -250);
    CHECK(at.part == 0);
}
