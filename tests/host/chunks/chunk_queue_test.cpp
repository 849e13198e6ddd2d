// SPDX-License-Identifier: MIT
// Chunks that come back in any order: what is known of them, and what is left of the others.
#include "myriad/host/chunks/chunk_queue.hpp"

#include <cstdint>
#include <vector>

#include "tests/catch.hpp"

namespace {

using myriad::host::chunk, myriad::host::chunk_plan, myriad::host::chunk_queue;

TEST_CASE("a queue hands out each chunk once, and then none") {
    chunk_queue chunks(chunk_plan(7), 7);
    const chunk all = chunks.take();
    CHECK((all.first == 0 && all.count == 7));
    CHECK(chunks.take().count == 0);
    CHECK(chunks.take().count == 0);
}

TEST_CASE("chunks that are back count at once, and as a whole up to the first that is not") {
    chunk_queue chunks(chunk_plan(10), 10);
    CHECK(chunks.bring_back(6, 8) == 2);
    CHECK(chunks.back_until() == 0);
    CHECK(chunks.bring_back(0, 4) == 6);
    CHECK(chunks.back_until() == 4);
    CHECK(chunks.bring_back(4, 6) == 8);
    CHECK(chunks.back_until() == 8);
    CHECK(chunks.back() == 8);
}

TEST_CASE("instances of chunks that are not back are given up, each once") {
    chunk_queue chunks(chunk_plan(10), 10);
    chunks.bring_back(0, 2);
    chunks.bring_back(6, 7);
    chunks.bring_back(3, 5);
    std::vector<std::int64_t> left;
    const auto leave = [&](std::int64_t i) { left.push_back(i); };
    chunks.give_up(leave);
    CHECK(left == std::vector<std::int64_t>{2, 5, 7, 8, 9});
    CHECK((chunks.back() == 10 && chunks.back_until() == 10));
    chunks.give_up(leave);
    CHECK(left.size() == 5);
}

}  // namespace
