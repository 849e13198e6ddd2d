// SPDX-License-Identifier: MIT
// The host's parallel loops reach every element once, however many threads there are.
#include "myriad/host/threads/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

#include "tests/catch.hpp"

TEST_CASE("a parallel loop reaches every element once, in parts no smaller than the grain") {
    for (const std::int64_t grain : {1, 7, 1000})
        for (const std::int64_t size : {0, 1, 6, 7, 13, 14, 999, 1000, 1001, 54'321}) {
            INFO(size << " elements, grain " << grain);
            std::vector<int> reached(static_cast<std::size_t>(size), 0);
            std::atomic<std::int64_t> parts{0}, smallest{size};
            myriad::host::in_parallel(size, grain, [&](std::int64_t first, std::int64_t last) {
                for (std::int64_t i = first; i < last; ++i) ++reached[static_cast<std::size_t>(i)];
                ++parts;
                std::int64_t least = smallest;
                while (last - first < least && !smallest.compare_exchange_weak(least, last - first)) {
                }
            });
            CHECK(std::count(reached.begin(), reached.end(), 1) == size);
            CHECK(parts <= std::clamp(size / grain, std::int64_t{size > 0}, myriad::host::most_threads));
            CHECK(smallest >= std::min(size, grain));
        }
}

TEST_CASE("a parallel loop leaves threads to a second one beside it, and two to others") {
    using myriad::host::team_size;
    CHECK(team_size(1) == 1);
    for (const std::int64_t available : {2, 3, 4, 5}) CHECK(team_size(available) == 2);
    for (const std::int64_t available : {6, 7, 8, 9, 12, 16, 17, 256}) {
        INFO(available << " threads");
        CHECK(2 * team_size(available) <= available - 2);
        CHECK(team_size(available) <= myriad::host::most_threads);
        CHECK(team_size(available) >= 2);
    }
    CHECK(team_size(16) == myriad::host::most_threads);
}
