// SPDX-License-Identifier: MIT
// Idle objects for reuse: found by their key, taken by only one user, and the oldest destroyed if there are too many.
#include "myriad/host/threads/object_pool.hpp"

#include <memory>
#include <string>

#include "tests/catch.hpp"

namespace {

using store = myriad::host::object_pool<std::string, int>;

TEST_CASE("what was given is taken once, by its key") {
    store s;
    CHECK(s.take("a") == nullptr);
    s.give("a", std::make_unique<int>(1));
    CHECK(s.take("b") == nullptr);
    const auto taken = s.take("a");
    REQUIRE(taken != nullptr);
    CHECK(*taken == 1);
    CHECK(s.take("a") == nullptr);
}

TEST_CASE("where more are idle than are to be kept, the oldest of them is destroyed") {
    store s;
    for (const int i : {1, 2, 3}) s.give("a", std::make_unique<int>(i));
    s.give("b", std::make_unique<int>(4));
    const auto concerns = [](const std::string& key) { return key == "a"; };
    s.keep_at_most(3, concerns);
    s.keep_at_most(2, concerns);
    CHECK(*s.take("a") == 2);
    CHECK(*s.take("a") == 3);
    CHECK(s.take("a") == nullptr);
    CHECK(*s.take("b") == 4);
}

}  // namespace
