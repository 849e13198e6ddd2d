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

}  // namespace
