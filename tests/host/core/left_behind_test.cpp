// SPDX-License-Identifier: MIT
// The state of moved-from objects: numbers are zero, and no thread is at work there.
#include "myriad/host/core/left_behind.hpp"

#include <utility>

#include "tests/catch.hpp"

namespace {

TEST_CASE("a number is zero in what it was moved out of") {
    myriad::host::moved_number<int> a = 3;
    myriad::host::moved_number<int> b(std::move(a)), c;
    CHECK(a == 0);
    CHECK(b == 3);
    c = std::move(b);
    CHECK(b == 0);
    CHECK(c == 3);
}

TEST_CASE("one user at a time has the right to work, until the turn ends") {
    myriad::host::occupancy occupied;
    {
        const auto turn = occupied.take("busy");
        CHECK_THROWS_WITH(occupied.take("busy"), "busy");
        myriad::host::occupancy moved(std::move(occupied));
        CHECK_NOTHROW(moved.take("busy"));
    }
    CHECK_NOTHROW(occupied.take("busy"));
}

}  // namespace
