// SPDX-License-Identifier: MIT
// The validation's arithmetic: a NaN in a result reaches the verdict.
#include "validation/measures/arithmetic.hpp"

#include "tests/catch.hpp"

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
using values = std::vector<double>;

}  // namespace

TEST_CASE("A state that is NaN in its first component is at no distance", "[validation]") {
    REQUIRE(std::isnan(validation::distance({missing, 1, 2}, {0, 0, 0})));
    REQUIRE(std::isnan(validation::distance({1, 2, missing}, {0, 0, 0})));
    REQUIRE(validation::distance({1, -3, 2}, {0, 0, 0}) == 3);
}

TEST_CASE("What is not known is not compared", "[validation]") {
    REQUIRE(validation::distance({1, 7}, {0.5, missing}) == 0.5);
}

TEST_CASE("The larger of a number and NaN is NaN, in either order", "[validation]") {
    REQUIRE(std::isnan(validation::larger(missing, 1)));
    REQUIRE(std::isnan(validation::larger(1, missing)));
    REQUIRE(validation::larger(1, 2) == 2);
    REQUIRE(validation::larger(2, 1) == 2);
    REQUIRE(std::isnan(validation::largest({1, missing, 2})));
    REQUIRE(validation::largest({1, 3, 2}) == 3);
}

TEST_CASE("The median of values with NaN among them is NaN", "[validation]") {
    REQUIRE(std::isnan(validation::median({3, missing, 1})));
    REQUIRE(std::isnan(validation::median({})));
    REQUIRE(validation::median({3, 1, 2}) == 2);
    REQUIRE(validation::median({4, 3, 1, 2}) == 3);
}

TEST_CASE("The median of ratios leaves out zeros below and keeps NaN", "[validation]") {
    REQUIRE(validation::median_ratio(values{4, 5, 6}, values{2, 0, 2}) == 3);
    REQUIRE(std::isnan(validation::median_ratio(values{4, missing, 6}, values{2, 1, 2})));
    REQUIRE(std::isnan(validation::median_ratio(values{4, 1, 6}, values{2, missing, 2})));
}
