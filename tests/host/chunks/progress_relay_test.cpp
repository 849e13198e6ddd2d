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

TEST_CASE("asking whether to stop calls the function now and then, and lets instances end for a second") {
    using myriad::detail::stop_request;
    std::vector<std::int64_t> seen;
    const std::function<void(std::int64_t, std::int64_t)> f = [&](std::int64_t done, std::int64_t) {
        seen.push_back(done);
        if (seen.size() == 3) throw std::runtime_error("enough");
    };
    relay r{f, 7, {}};
    CHECK(relay::ask(&r) == stop_request::none);
    CHECK(seen.empty());
    r.last_call -= 2 * relay::ask_every;
    CHECK(relay::ask(&r) == stop_request::none);
    CHECK(relay::call(&r, 2));
    for (int i = 0; i < 5; ++i) CHECK(relay::ask(&r) == stop_request::none);
    CHECK(seen == std::vector<std::int64_t>{0, 2});
    r.last_call -= 2 * relay::ask_every;
    CHECK(relay::ask(&r) == stop_request::begin_no_more);
    CHECK(seen == std::vector<std::int64_t>{0, 2, 2});
    CHECK(relay::ask(&r) == stop_request::begin_no_more);
    r.failed_at -= 2 * relay::patience;
    CHECK(relay::ask(&r) == stop_request::end_now);
    CHECK(seen.size() == 3);
}

}  // namespace
