// SPDX-License-Identifier: MIT
// Progress on its way to the user's function: an exception stops the work and is kept.
#include "myriad/host/chunks/progress_relay.hpp"

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <vector>

#include "tests/catch.hpp"

namespace {

using relay = myriad::host::progress_relay;

TEST_CASE("progress reaches the function with the total") {
    std::vector<std::int64_t> seen;
    const std::function<void(std::int64_t, std::int64_t)> f = [&](std::int64_t done, std::int64_t total) {
        seen.insert(seen.end(), {done, total});
    };
    relay r{f, 7, {}};
    CHECK(relay::call(&r, 2));
    CHECK(relay::call(&r, 7));
    CHECK(seen == std::vector<std::int64_t>{2, 7, 7, 7});
}

TEST_CASE("without a function the work goes on") {
    const std::function<void(std::int64_t, std::int64_t)> none;
    relay r{none, 7, {}};
    CHECK(relay::call(&r, 2));
}

TEST_CASE("what the function throws is kept, and it is not called again") {
    int calls = 0;
    const std::function<void(std::int64_t, std::int64_t)> f = [&](std::int64_t, std::int64_t) {
        ++calls;
        throw std::runtime_error("enough");
    };
    relay r{f, 7, {}};
    CHECK_FALSE(relay::call(&r, 2));
    CHECK_FALSE(relay::call(&r, 3));
    CHECK(calls == 1);
    CHECK_THROWS_WITH(std::rethrow_exception(r.failure), "enough");
}

}  // namespace
