// SPDX-License-Identifier: MIT
// The first crossing of a step, for a motion whose crossings are known in closed form.
#include "myriad/kernel/event/earliest_crossing.hpp"

#include <cmath>

#include "tests/catch.hpp"

namespace {

using myriad::detail::earliest_crossing;
using myriad::detail::earliest_crossing_between;

/// x = t - t^2 / 2 relative to three levels; and the time left until t = 1, which is the parameter p.
struct thrown {
    enum state { x, n_state };
    enum parameter { alarm, n_parameter };
    enum event { ground, middle, top, rings, n_event };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>&, const auto&) {
        return {R(1.0) - t};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[x], y[x] - R(0.25), y[x] - R(0.375), p[alarm] - t};
    }
};

using flags = myriad::detail::mask_set<bool, thrown::n_event>;
using values = myriad::vec<double, thrown::n_event>;

struct step : myriad::detail::step_ends<thrown, double> {
    static constexpr double closest = 1e-9;
    values tolerance;  // of all functions the same

    step(double from, double to, double alarm_at = 10) : step_ends(myriad::inputs<thrown, double>{}) {
        p.parameter[thrown::alarm] = alarm_at;
        t = from, h = to - from, t1 = to;
        y = {from - from * from / 2}, y1 = {to - to * to / 2};
        slope = {1 - from}, slope1 = {1 - to};
        g = myriad::detail::evaluate_events<thrown>(t, y, p);
        g1 = myriad::detail::evaluate_events<thrown>(t1, y1, p);
        for (int j = 0; j < thrown::n_event; ++j) tolerance[j] = closest;
    }
    /// The crossings between the signs at both ends, except those excluded.
    auto first(values side) const {
        flags crossed;
        crossed.clear();
        for (int j = 0; j < thrown::n_event; ++j) crossed.set(j, side[j] * g1[j] < 0);
        return earliest_crossing(*this, side, crossed, flags::all_in(true), tolerance);
    }
};

constexpr double epsilon = 2.3e-16;

TEST_CASE("of several crossings in a step the first in time is found, whichever its index") {
    const step up(0, 1);  // through 0.25 at 1 - sqrt(0.5), then 0.375 at 0.5
    const auto found = up.first({1, -1, -1, 1});
    CHECK(found.event == thrown::middle);
    CHECK(std::abs(found.fraction - (1 - std::sqrt(0.5))) <= 1e-10);

    const step with_alarm(0, 1, 0.2);
    CHECK(with_alarm.first({1, -1, -1, 1}).event == thrown::rings);
    CHECK(std::abs(with_alarm.first({1, -1, -1, 1}).fraction - 0.2) <= 4 * epsilon);

    const step down(1, 2.5);  // through 0.375 at 1.5, 0.25 at 1 + sqrt(0.5), 0 at 2
    CHECK(down.first({1, 1, 1, 1}).event == thrown::top);
    CHECK(std::abs(down.first({1, 1, 1, 1}).fraction - 0.5 / 1.5) <= 1e-10);
}

TEST_CASE("a step backwards in time meets its crossings in that order") {
    const step back(2.5, 1);
    const auto found = back.first({-1, -1, -1, 1});
    CHECK(found.event == thrown::ground);
    CHECK(std::abs(found.fraction - 0.5 / 1.5) <= 1e-10);
}

TEST_CASE("of events at one instant the first by index is found") {
    const step both(0, 1, 0.5);  // 0.375 is passed as the alarm rings
    CHECK(std::abs(both.first({1, 0, -1, 1}).fraction - 0.5) <= 1e-10);

    flags crossed;
    crossed.clear();
    crossed.set(thrown::top, true);
    crossed.set(thrown::rings, true);
    const auto found = myriad::detail::first_of<double>(crossed, [](int) { return 0.5; });
    CHECK(found.event == thrown::top);
    CHECK(found.fraction == 0.5);
}

TEST_CASE("a flight that starts on the surface crosses where it comes back") {
    const step flight(0, 2.5);
    const auto found = flight.first({1, 0, 0, 0});
    CHECK(found.event == thrown::ground);
    CHECK(std::abs(found.fraction - 2 / 2.5) <= 1e-10);
}

TEST_CASE("a function on the surface that does not leave it crosses where the step begins") {
    const step falls(2, 2.5);
    CHECK(falls.first({1, 0, 0, 0}).fraction == 0);
}

TEST_CASE("between two samples the secant tells the crossing, and a half where a function starts on the surface") {
    const step up(0, 1, 0.7);
    flags crossed;
    crossed.clear();
    crossed.set(thrown::rings, true);
    const auto found = earliest_crossing_between(0.5, 0.75, up, crossed);
    CHECK(found.event == thrown::rings);
    CHECK(std::abs(found.fraction - 0.7) <= 4 * epsilon);
    CHECK(std::abs(earliest_crossing_between(0.5, 1.0, up, crossed).fraction - 0.7) <= 4 * epsilon);

    crossed.clear();
    crossed.set(thrown::ground, true);
    CHECK(earliest_crossing_between(0.0, 0.5, up, crossed).fraction == 0.25);
}

}  // namespace
