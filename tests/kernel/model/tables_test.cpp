// SPDX-License-Identifier: MIT
// Elements of tables for plain numbers, lanes of packs and dual numbers.
#include "myriad/kernel/model/tables.hpp"

#include <limits>

#include "myriad/kernel/scalar/pack.hpp"
#include "tests/catch.hpp"

using myriad::find_interval;
using myriad::lookup;

namespace {

constexpr double knots[] = {-1, 0, 0.5, 2, 7};
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("a table's element is that of the nearest row there is") {
    CHECK(lookup(knots, 1, 5, 3.0) == 2);
    CHECK(lookup(knots + 1, 2, 2, 1.0) == 2);
    CHECK(lookup(knots, 1, 5, -3.0) == -1);
    CHECK(lookup(knots, 1, 5, 1e300) == 7);
    CHECK(lookup(knots, 1, 5, no_number) == -1);
}

TEST_CASE("an interval of knots begins at or before the point in it") {
    CHECK(find_interval(knots, 5, -1.0) == 0);
    CHECK(find_interval(knots, 5, 0.0) == 1);
    CHECK(find_interval(knots, 5, 0.49) == 1);
    CHECK(find_interval(knots, 5, 6.9) == 3);
    CHECK(find_interval(knots, 5, 7.0) == 3);
    CHECK(find_interval(knots, 5, -9.0) == 0);
    CHECK(find_interval(knots, 5, 9.0) == 3);
    CHECK(find_interval(knots, 5, no_number) >= 0);
    CHECK(find_interval(knots, 2, 0.0) == 0);
}

TEST_CASE("lanes and dual numbers have the elements of plain numbers") {
    using lanes = myriad::pack<double, 2>;
    lanes x(0);
    for (int i = 0; i < lanes::lanes; ++i) lanes::set_lane(x, i, -1.5 + 0.6 * i);
    const lanes place = find_interval(knots, 5, x), found = lookup(knots, 1, 5, place);
    for (int i = 0; i < lanes::lanes; ++i) {
        const double expected = find_interval(knots, 5, lanes::get_lane(x, i));
        CHECK(lanes::get_lane(place, i) == expected);
        CHECK(lanes::get_lane(found, i) == lookup(knots, 1, 5, expected));
    }
    const myriad::dual<double> y(0.7, 1.0);
    CHECK(find_interval(knots, 5, y).value == 2);
    CHECK(lookup(knots, 1, 5, y).value == -1);
    CHECK(lookup(knots, 1, 5, y).derivative == 0);
}
