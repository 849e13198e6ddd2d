// SPDX-License-Identifier: MIT
// Exact sums, against integers and against sums known exactly.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <myriad/study/plan/exact_sum.hpp>

#include "tests/catch.hpp"

namespace {

using myriad::studies::exact_sum;

double sum_of(const std::vector<double>& all) {
    exact_sum sum;
    for (const double value : all) sum.add(value);
    return sum.value();
}

}  // namespace

TEST_CASE("A sum has no rounding error but the last", "[exact_sum]") {
    CHECK(sum_of({}) == 0);
    CHECK(sum_of({1e308, 1, -1e308}) == 1);
    CHECK(sum_of({1, 1e-300, -1}) == 1e-300);
    CHECK(sum_of({1e16, 1, 1, -1e16}) == 2);
    CHECK(sum_of({-3.5}) == -3.5);
    CHECK(sum_of({0.1, 0.2}) == 0.1 + 0.2);  // one rounding, as of a single addition
    CHECK(sum_of(std::vector<double>(10, 0.1)) == 1);
    const double least = std::numeric_limits<double>::denorm_min(), most = std::numeric_limits<double>::max();
    CHECK(sum_of({least, least, -1.0, 1.0}) == 2 * least);
    CHECK(sum_of({most, least}) == most);
    CHECK(std::isinf(sum_of({most, most})));
}
TEST_CASE("A sum is rounded to nearest, ties to even", "[exact_sum]") {
    const double one = 1, half = 0x1p-53, tiny = 0x1p-1000;
    CHECK(sum_of({one, half}) == one);  // a tie, to the even neighbour
    CHECK(sum_of({one, half, tiny}) == std::nextafter(one, 2));
    CHECK(sum_of({one, half, -tiny}) == one);
    CHECK(sum_of({-one, -half, -tiny}) == -std::nextafter(one, 2));
    CHECK(sum_of({std::nextafter(one, 2), half}) == 1 + 0x1p-51);  // a tie, to the even neighbour
}
TEST_CASE("Sums of integers are those of integers", "[exact_sum]") {
    std::mt19937_64 random(1);
    for (int round = 0; round < 200; ++round) {
        __int128 expected = 0;
        exact_sum sum;
        for (int i = 0; i < 100; ++i) {
            const auto number = static_cast<std::int64_t>(random()) >> (random() % 60);
            const auto rounded = static_cast<double>(number);  // an integer too
            expected += static_cast<__int128>(rounded);
            sum.add(rounded);
        }
        CHECK(sum.value() == static_cast<double>(expected));  // which rounds to nearest
    }
}
TEST_CASE("A sum does not depend on the order, nor on how it is divided", "[exact_sum]") {
    std::mt19937_64 random(2);
    std::vector<double> all(1000);
    for (double& value : all)
        value = std::ldexp(static_cast<double>(random()), static_cast<int>(random() % 2000) - 1100);
    for (std::size_t i = 0; i < all.size(); i += 3) all[i] = -all[i];
    const double expected = sum_of(all);
    std::shuffle(all.begin(), all.end(), random);
    CHECK(sum_of(all) == expected);
    exact_sum together;
    for (std::size_t first = 0; first < all.size(); first += 37) {
        exact_sum part;
        for (std::size_t i = first; i < std::min(first + 37, all.size()); ++i) part.add(all[i]);
        std::int64_t stored[exact_sum::digits];
        part.store(stored);
        for (std::size_t d = 0; d + 1 < exact_sum::digits; ++d)
            REQUIRE((stored[d] >= 0 && stored[d] < std::int64_t{1} << 32));
        together.add(stored);
    }
    CHECK(together.value() == expected);
}
