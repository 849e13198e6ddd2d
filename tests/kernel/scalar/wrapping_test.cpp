// SPDX-License-Identifier: MIT
// Whole numbers that go round at the ends of their range, plain and in packs whose lanes are wider.
#include "myriad/kernel/scalar/wrapping.hpp"

#include <cstdint>
#include <limits>

#include "myriad/kernel/scalar/pack.hpp"
#include "tests/catch.hpp"

namespace {

using myriad::detail::get_lane;
constexpr std::int32_t largest = std::numeric_limits<std::int32_t>::max();
constexpr std::int32_t least = std::numeric_limits<std::int32_t>::min();

}  // namespace

TEST_CASE("sums, differences and products of whole numbers go round at the ends of their range") {
    CHECK(myriad::wrapping_add(largest, 1) == least);
    CHECK(myriad::wrapping_subtract(least, 1) == largest);
    CHECK(myriad::wrapping_multiply(1 << 20, 1 << 20) == 0);
    CHECK(myriad::wrapping_multiply(65537, 65537) == 131073);
    CHECK(myriad::wrapping_add(std::int64_t{largest}, 1) == std::int64_t{1} << 31);
}

TEMPLATE_TEST_CASE("whole numbers in packs have 32 bits, whatever the width of their lanes", "", std::int64_t,
                   std::int32_t) {
    using P = myriad::pack<TestType, 2>;
    const P sum = myriad::wrapping_add(P(largest), 1), difference = myriad::wrapping_subtract(P(least), P(2));
    const P small = myriad::wrapping_subtract(-7, P(5));
    for (int i = 0; i < P::lanes; ++i) {
        CHECK(get_lane(sum, i) == least);
        CHECK(get_lane(difference, i) == largest - 1);
        CHECK(get_lane(small, i) == -12);
    }
}
