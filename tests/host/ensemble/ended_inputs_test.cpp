// SPDX-License-Identifier: MIT
// The record of instances that have ended: each is stored once, found by its index, with a digest that identifies its
// inputs.
#include "myriad/host/ensemble/ended_inputs.hpp"

#include <cstdint>
#include <vector>

#include "tests/catch.hpp"

namespace {

using myriad::host::digest;
using myriad::host::ended_instance;
using myriad::host::ended_instances;

digest of(std::initializer_list<double> values) {
    digest d;
    for (const double value : values) d.add(value);
    return d;
}

TEST_CASE("digests differ by value, by order and by the sign of zero") {
    CHECK(of({1, 2}) == of({1, 2}));
    CHECK_FALSE(of({1, 2}) == of({2, 1}));
    CHECK_FALSE(of({1}) == of({1, 0}));
    CHECK_FALSE(of({0.0}) == of({-0.0}));
}

TEST_CASE("instances that have ended are added once and found by their index, whenever they ended") {
    ended_instances<double> all;
    int made = 0;
    const auto add = [&](const std::vector<std::uint8_t>& ended) {
        all.add(ended.data(), static_cast<std::int64_t>(ended.size()), [&](std::int64_t i) {
            ++made;
            return ended_instance<double>{i, of({static_cast<double>(i)}), 0, 1.0 * made};
        });
    };
    add({0, 1, 0, 0, 1});
    CHECK(made == 2);
    add({1, 1, 0, 1, 1});
    CHECK(made == 4);
    std::vector<std::int64_t> indices;
    for (const auto& e : all) indices.push_back(e.index);
    CHECK(indices == std::vector<std::int64_t>{0, 1, 3, 4});
    REQUIRE(all.find(4) != nullptr);
    CHECK(all.find(4)->t_end == 2);  // as it was first stored
    CHECK(all.find(2) == nullptr);
    CHECK(all.find(5) == nullptr);
    all.clear();
    CHECK(all.find(4) == nullptr);
}

}  // namespace
