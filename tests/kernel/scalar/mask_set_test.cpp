// SPDX-License-Identifier: MIT
// Masks under numbers, of packs and as the bits of one instance's words.
#include "myriad/kernel/scalar/mask_set.hpp"

#include "myriad/kernel/scalar/pack.hpp"
#include "tests/catch.hpp"

namespace {

using myriad::detail::mask_set;

TEST_CASE("masks of one instance are set and read one by one, beyond the bits of a word too") {
    mask_set<bool, 70> masks;
    masks.clear();
    CHECK_FALSE(masks.any_of());
    for (const int j : {0, 31, 32, 69}) {
        masks.set(j, true);
        for (int k = 0; k < 70; ++k) CHECK(masks[k] == (k == j));
        CHECK(masks.any_of());
        masks.set(j, false);
        CHECK_FALSE(masks.any_of());
    }
}

TEST_CASE("masks of a pack are set lane by lane, and joined lane by lane") {
    using mask = myriad::mask_of<myriad::pack<double, 1>>;
    mask_set<mask, 3> masks;
    masks.clear();
    masks.set(1, 0, true);
    CHECK(masks.get(1, 0));
    CHECK_FALSE(masks.get(0, 0));
    CHECK(myriad::detail::get_lane(masks.any_of(), 0));
    masks.set(1, mask(false));
    CHECK_FALSE(masks.get(1, 0));
}

TEST_CASE("operators work on all masks at once, and on no bits beyond them") {
    mask_set<bool, 70> even, high;
    even.clear();
    high.clear();
    for (int j = 0; j < 70; j += 2) even.set(j, true);
    for (int j = 32; j < 70; ++j) high.set(j, true);
    const auto both = even & high, either = even | high, one = even ^ high, odd = ~even;
    for (int j = 0; j < 70; ++j) {
        CAPTURE(j);
        CHECK(both[j] == (j % 2 == 0 && j >= 32));
        CHECK(either[j] == (j % 2 == 0 || j >= 32));
        CHECK(one[j] == (either[j] && !both[j]));
        CHECK(odd[j] == (j % 2 == 1));
    }
    CHECK((even | odd).all_of());
    CHECK_FALSE(either.all_of());
    CHECK_FALSE((~(even | odd)).any_of());
    CHECK_FALSE(even.in(false).any_of());
    CHECK(even.in(true)[2]);
}

TEST_CASE("negative numbers set their masks alone") {
    const auto check = []<class R>(R) {
        mask_set<bool, 70> below;
        below.clear();
        for (int j = 0; j < 70; ++j) below.set_negative(j, j % 3 == 0 ? R(-1.5) : R(1.5));
        for (int j = 0; j < 70; ++j) CHECK(below[j] == (j % 3 == 0));
        mask_set<myriad::mask_of<myriad::pack<R, 1>>, 2> lanes;
        lanes.clear();
        lanes.set_negative(1, myriad::pack<R, 1>(R(-2)));
        CHECK_FALSE(lanes.get(0, 0));
        CHECK(lanes.get(1, 0));
    };
    check(double{});
    check(float{});
}

TEST_CASE("operators work on each lane of a pack by itself") {
    using mask = myriad::mask_of<myriad::pack<double, 1>>;
    const std::uint32_t bits[] = {0b01};
    auto first = mask_set<mask, 2>::from_bits(bits);
    CHECK(first.get(0, 0));
    CHECK_FALSE(first.get(1, 0));
    CHECK(myriad::detail::get_lane((first | ~first).all_of(), 0));
    CHECK_FALSE(myriad::detail::get_lane((first & ~first).any_of(), 0));
    CHECK_FALSE((first ^ first).get(0, 0));
    if (myriad::lanes_of < myriad::pack < double, 1 >>> 1) {
        first.set(1, 1, true);
        CHECK(first.get(1, 1));
        CHECK_FALSE(first.in(!first[1]).get(0, 1));
        CHECK(first.in(!first[1]).get(0, 0));
    }
}

}  // namespace
