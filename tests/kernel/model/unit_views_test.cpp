// SPDX-License-Identifier: MIT
// What a debug build checks of units' numbers, whatever the preset; and what their event functions find.
#undef NDEBUG
#include "myriad/kernel/model/unit_views.hpp"

#include <cstdint>
#include <string>

#include <myriad/coupled_units.hpp>

#include "myriad/kernel/event/event_functions.hpp"
#include "tests/catch.hpp"
#include "tests/kernel/model/teams.hpp"
#include "tests/kernel/model/unit_models.hpp"
#include "tests/support/message_of.hpp"

TEST_CASE("a debug build finds a unit that reads beyond the last one") {
    using W = units::pointing_at_2;
    std::int32_t target[] = {1, 0};
    myriad::inputs<W, double> p;
    p.shared = static_cast<const double*>(nullptr);
    p.shared_integer = target;
    const myriad::vec<double, 2> y{3, 4};
    const auto slopes = W::rhs<double>(0.0, y, p);
    CHECK(slopes[0] == 4);
    CHECK(slopes[1] == 3);
    for (const std::int32_t beyond : {2, -1}) {
        target[1] = beyond;
        CHECK(tests::message_of([&] { W::rhs<double>(0.0, y, p); }) ==
              "a unit reads unit " + std::to_string(beyond) +
                  ", but there are 2 units, counted from 0: write its number round the ends, (unit + 1) % y.units, or "
                  "leave the last one out");
    }
}

TEST_CASE("the slopes of several events of a unit are the unit's, and not those of the last unit") {
    using W = teams::hoppers<1>;  // g++ -O3 made two loops of the one over the units
    myriad::detail::lane_data<W, double> p{};
    myriad::vec<double, W::n_state> y, slope;
    for (int c = 0; c < W::n_state; ++c) {
        y[c] = 1;
        slope[c] = c;
    }
    const auto found = myriad::detail::event_slopes<W>(0.0, y, slope, static_cast<const myriad::inputs<W, double>&>(p));
    for (int unit = 0; unit < W::n_unit; ++unit) {
        CHECK(found[2 * unit + teams::hopper::landing] == 2 * unit);
        CHECK(found[2 * unit + teams::hopper::turning] == 2 * unit + 1);
    }
}
