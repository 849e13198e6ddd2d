// SPDX-License-Identifier: MIT
// The watch over signs of life.
#include "myriad/study/store/signs_of_life.hpp"

#include <thread>

#include "tests/catch.hpp"

namespace {

using myriad::studies::signs_of_life;
using std::chrono::milliseconds;

TEST_CASE("who gives no sign for longer than the expiry is silent, whatever the sign is") {
    for (const std::int64_t sign : {std::int64_t{0}, std::int64_t{-5}, std::int64_t{1} << 62}) {
        signs_of_life watch(milliseconds(40));
        CHECK_FALSE(watch.is_silent("a", sign));
        bool silent = false;
        for (int look = 0; look < 200 && !(silent = watch.is_silent("a", sign)); ++look)
            std::this_thread::sleep_for(milliseconds(2));
        CHECK(silent);
        CHECK_FALSE(watch.is_silent("b", sign));
        CHECK_FALSE(watch.is_silent("a", sign - 1));  // also if its clock went back
    }
}

TEST_CASE("who slept with the others takes nobody for dead when it wakes") {
    signs_of_life watch(milliseconds(40));
    CHECK_FALSE(watch.is_silent("a", 7));
    std::this_thread::sleep_for(milliseconds(400));
    CHECK_FALSE(watch.is_silent("a", 7));
    std::this_thread::sleep_for(milliseconds(400));
    CHECK_FALSE(watch.is_silent("a", 7));
}

}  // namespace
