// SPDX-License-Identifier: MIT
// Floored quotients and remainders: values that Python gives, and packs against plain numbers.
#include "myriad/kernel/scalar/floored_division.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "myriad/kernel/scalar/pack.hpp"
#include "tests/catch.hpp"

namespace {

using myriad::pack;
using myriad::detail::get_lane;
using myriad::detail::set_lane;

constexpr double inf = std::numeric_limits<double>::infinity();

bool same_bits(double a, double b) {
    return (std::isnan(a) && std::isnan(b)) || std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

}  // namespace

TEST_CASE("remainders and quotients of real numbers are those that Python gives") {
    struct {
        double a, b, remainder, quotient;
    } const cases[] = {
        {0.5, 1e-3, 0.0009999999999999896, 499},
        {1, 0.1, 0.09999999999999995, 9},
        {-1e-20, 1, 1, -1},
        {5.3, -0.7, -0.2999999999999998, -8},
        {7.5, 2, 1.5, 3},
        {-7.5, 2, 0.5, -4},
        {7.5, -2, -0.5, -4},
        {-7.5, -2, -1.5, 3},
        {-6, 2, 0.0, -3},
        {6, -2, -0.0, -3},
        {-0.0, 3, 0.0, -0.0},
        {0, -3, -0.0, -0.0},
        {1, inf, 1, 0},
        {-1, inf, inf, -1},
        {1e308, 3e-300, std::fmod(1e308, 3e-300), inf},
    };
    for (const auto& c : cases) {
        CAPTURE(c.a, c.b);
        CHECK(same_bits(myriad::floor_mod(c.a, c.b), c.remainder));
        CHECK(same_bits(myriad::floor_divide(c.a, c.b), c.quotient));
    }
    CHECK(std::isnan(myriad::floor_mod(1.0, 0.0)));
    CHECK(myriad::floor_divide(1.0, 0.0) == inf);
}

TEST_CASE("packs have the remainders and quotients of plain numbers, bit for bit") {
    using P = pack<double, 2>;
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> digits(-10, 10), decades(-40, 40);
    const auto draw = [&](int k) {
        const double special[] = {0.0, -0.0, inf, -inf, 1, 3, 0.1, 5e-324, 1e308, std::nan("")};
        return k % 7 == 0 ? special[random() % 10] : digits(random) * std::pow(10.0, k % 2 ? 0 : decades(random));
    };
    for (int k = 0; k < 20000; ++k) {
        P a, b;
        for (int i = 0; i < P::lanes; ++i) set_lane(a, i, draw(k + i)), set_lane(b, i, draw(k + 3 * i + 1));
        const P remainder = myriad::floor_mod(a, b), quotient = myriad::floor_divide(a, b);
        for (int i = 0; i < P::lanes; ++i) {
            const double x = get_lane(a, i), y = get_lane(b, i);
            CAPTURE(x, y, get_lane(remainder, i), myriad::floor_mod(x, y));
            REQUIRE(same_bits(get_lane(remainder, i), myriad::floor_mod(x, y)));
            REQUIRE(same_bits(get_lane(quotient, i), myriad::floor_divide(x, y)));
        }
    }
}

TEST_CASE("whole numbers are divided as in Python, and by zero and at the end of their range without a trap") {
    const std::int32_t least = std::numeric_limits<std::int32_t>::min();
    CHECK((myriad::floor_mod(7, 2) == 1 && myriad::floor_divide(7, 2) == 3));
    CHECK((myriad::floor_mod(-7, 2) == 1 && myriad::floor_divide(-7, 2) == -4));
    CHECK((myriad::floor_mod(7, -2) == -1 && myriad::floor_divide(7, -2) == -4));
    CHECK((myriad::floor_mod(-6, 3) == 0 && myriad::floor_divide(-6, 3) == -2));
    CHECK((myriad::floor_mod(5, 0) == 0 && myriad::floor_divide(5, 0) == 0));
    CHECK((myriad::floor_mod(least, -1) == 0 && myriad::floor_divide(least, -1) == least));
    CHECK(myriad::floor_mod(std::int64_t{-1} << 40, 3) == 2);
}
