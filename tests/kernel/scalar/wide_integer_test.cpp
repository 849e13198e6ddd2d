// SPDX-License-Identifier: MIT
// Integers of 64 bits in packs of 32, against plain ones.

#include "myriad/kernel/scalar/wide_integer.hpp"

#include <cstdint>
#include <vector>

#include "myriad/kernel/model/lane.hpp"
#include "myriad/kernel/scalar/pack.hpp"
#include "tests/catch.hpp"

namespace {

using narrow = myriad::pack<std::int32_t, 2>;
using wide = myriad::wide_integer<narrow>;
using myriad::detail::get_lane;
using myriad::detail::set_lane;

constexpr int lanes = narrow::lanes;

/// Numbers around those at which the halves carry.
std::vector<std::int64_t> numbers() {
    std::vector<std::int64_t> all;
    for (const std::int64_t middle : {std::int64_t{0}, std::int64_t{1} << 31, std::int64_t{1} << 32,
                                      std::int64_t{5} << 32, -(std::int64_t{1} << 32), std::int64_t{1} << 62})
        for (std::int64_t by = -2; by <= 2; ++by) all.push_back(middle + by);
    return all;
}

}  // namespace

TEST_CASE("numbers of instances have 64 bits in packs of both real types") {
    STATIC_REQUIRE(std::is_same_v<myriad::detail::index_of<myriad::pack<double, 2>>, myriad::pack<std::int64_t, 2>>);
    STATIC_REQUIRE(std::is_same_v<myriad::detail::index_of<myriad::pack<float, 2>>, wide>);
    STATIC_REQUIRE(std::is_same_v<myriad::detail::index_of<float>, std::int64_t>);
}

TEST_CASE("a pack of wide integers computes and compares as its lanes do") {
    const std::vector<std::int64_t> all = numbers();
    for (std::size_t i = 0; i < all.size(); ++i) {
        wide a(0);
        const wide b(all[i]);
        for (int l = 0; l < lanes; ++l) set_lane(a, l, all[(i + static_cast<std::size_t>(l) * 7) % all.size()]);
        const wide sum = a + b, difference = a - b;
        const auto less = a < b, equal = a == b, chosen = a >= b;
        const wide larger = myriad::select(chosen, a, b);
        for (int l = 0; l < lanes; ++l) {
            const std::int64_t x = get_lane(a, l), y = all[i];
            CHECK(x == all[(i + static_cast<std::size_t>(l) * 7) % all.size()]);
            CHECK(get_lane(sum, l) == x + y);
            CHECK(get_lane(difference, l) == x - y);
            CHECK(get_lane(less, l) == (x < y));
            CHECK(get_lane(equal, l) == (x == y));
            CHECK(get_lane(a > b, l) == (x > y));
            CHECK(get_lane(a <= b, l) == (x <= y));
            CHECK(get_lane(a != b, l) == (x != y));
            CHECK(get_lane(larger, l) == std::max(x, y));
            CHECK(get_lane(static_cast<narrow>(a), l) == static_cast<std::int32_t>(static_cast<std::uint32_t>(x)));
        }
    }
}
