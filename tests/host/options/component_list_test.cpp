// SPDX-License-Identifier: MIT
// Lists of components in options: their numbers, and the enumerations through which they were given.
#include "myriad/host/options/component_list.hpp"

#include <cstdint>
#include <limits>
#include <vector>

#include "tests/catch.hpp"
#include "tests/support/problems.hpp"

namespace {

using myriad::component_list;
using problems::oscillator;

TEST_CASE("components are numbers, in the order in which they were given") {
    const component_list list{2, 0, 1};
    CHECK(list.size() == 3);
    CHECK(std::vector<int>(list.begin(), list.end()) == std::vector<int>{2, 0, 1});
    CHECK(component_list().empty());
    CHECK(list == component_list(std::vector<int>{2, 0, 1}));
    CHECK_FALSE(list == component_list{0, 1, 2});
}

TEST_CASE("a component given by an enumerator remembers its enumeration, and one given by a number has none") {
    const component_list list{oscillator::v, 0};
    CHECK(list[0] == 1);
    CHECK(list.enumeration(0).find("oscillator::state") != std::string_view::npos);
    CHECK(list.enumeration(1).empty());
    CHECK(list == component_list{1, 0});
}

TEST_CASE("a number that no int holds stays beyond every component") {
    const component_list list{std::int64_t{1} << 40, -(std::int64_t{1} << 40)};
    CHECK(list[0] == std::numeric_limits<int>::max());
    CHECK(list[1] == std::numeric_limits<int>::min());
}

}  // namespace
