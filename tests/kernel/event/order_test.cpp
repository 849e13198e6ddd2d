// SPDX-License-Identifier: MIT
// Several events in one step, and their actions: order in time, simultaneous events, stopping, which action runs, jumps
// and resets by an action, and the steps that follow.
#include "tests/catch.hpp"
#include "tests/kernel/event/logged_motions.hpp"

using namespace logged_motions;

namespace {

constexpr motion drift{.x = 0, .v = 1};  // x = t, without error but for rounding

std::vector<int> order_of(const std::vector<firing>& log) {
    std::vector<int> events;
    for (const firing& f : log) events.push_back(f.event);
    return events;
}

}  // namespace

TEMPLATE_TEST_CASE("events within one step are handled in order of time and not of index", "", ALL_METHODS) {
    struct times {
        double t[3];
        std::vector<int> order;
    };
    const std::vector<times> cases = {{{0.2, 0.45, 0.7}, {0, 1, 2}},
                                      {{0.7, 0.2, 0.45}, {1, 2, 0}},
                                      {{0.45, 0.7, 0.2}, {2, 0, 1}},
                                      {{0.7, 0.45, 0.2}, {2, 1, 0}}};
    for (const times& c : cases) {
        for (const bool of_time : {true, false}) {
            CAPTURE(c.t[0], c.t[1], c.t[2], of_time);
            const auto at = [&](int j) { return of_time ? time(c.t[j]) : position(c.t[j]); };
            auto e = ensemble_of(drift, {at(0), at(1), at(2)}, 0, 1);
            solve<TestType>(e, options_for(1e-12, 1));  // the first step reaches the end
            const auto log = log_of(e);
            CHECK(order_of(log) == c.order);
            for (const firing& f : log) CHECK(std::abs(f.t - c.t[f.event]) <= 2e-12);
        }
    }
}

TEMPLATE_TEST_CASE("events closer together than rounding fire once each", "", ALL_METHODS) {
    auto e = ensemble_of(drift, {position(0.3 + 1e-16), position(0.3), position(0.3 + 1e-13)}, 0, 1);
    solve<TestType>(e, options_for(1e-12, 1));
    auto order = order_of(log_of(e));
    std::sort(order.begin(), order.end());
    CHECK(order == std::vector<int>{0, 1, 2});
}

TEMPLATE_TEST_CASE("simultaneous events each fire once, in order of index", "", ALL_METHODS) {
    const function third{.X = -2, .c = -0.6};  // falls where the others rise
    const function steep{.X = 1000, .c = 300};
    for (const std::array<function, 3>& functions :
         {std::array{position(0.3), position(0.3), position(0.3)}, std::array{time(0.3), time(0.3), time(0.3)},
          std::array{position(0.3), third, steep}, std::array{steep, third, position(0.3)}}) {
        auto e = ensemble_of(drift, functions, 0, 1);
        const auto report = solve<TestType>(e, options_for(1e-9, 1));
        CHECK(report.count(myriad::status::success) == 1);
        const auto log = log_of(e);
        CHECK(order_of(log) == std::vector<int>{0, 1, 2});
        for (const firing& f : log) CHECK(std::abs(f.t - 0.3) <= 1e-9);
    }
}

TEMPLATE_TEST_CASE("simultaneous events at the end of a step each fire once", "", ALL_METHODS) {
    auto e = ensemble_of(drift, {position(0.5), position(0.5), time(0.5)}, 0, 1);
    auto o = options_for(1e-9, 0.25);  // exact in binary: a step ends on the events
    o.maximum_step = 0.25;
    solve<TestType>(e, o);
    CHECK(order_of(log_of(e)) == std::vector<int>{0, 1, 2});
}

TEMPLATE_TEST_CASE("simultaneous events at the end of the domain each fire once", "", ALL_METHODS) {
    auto e = ensemble_of(drift, {time(1), time(1), function{.T = -3, .c = -3}}, 0, 1);
    solve<TestType>(e, options_for(1e-9, 0.25));
    CHECK(order_of(log_of(e)) == std::vector<int>{0, 1, 2});
}

TEMPLATE_TEST_CASE("a phase stops after the chosen number of detections of an event", "", ALL_METHODS) {
    for (const std::int64_t n : {1, 2, 3}) {
        auto e = ensemble_of(sine, {position(), velocity(), never()}, 0, 20);
        auto o = options_for(1e-10, 1e-3);
        o.events[0].stop_after = n;
        const auto report = solve<TestType>(e, o);
        CHECK(report.count(myriad::status::stopped_by_event) == 1);
        CHECK(times_of(e, 0).size() == static_cast<std::size_t>(n));
        CHECK(times_of(e, 1).size() == static_cast<std::size_t>(n));  // the other events are counted up to there
        CHECK(std::abs(e.t()[0] - pi * static_cast<double>(n)) <= 1e-9);
        CHECK(std::abs(e.state(logged_motion::x)[0]) <= 1e-10);  // the tolerance of the event
    }
}

TEMPLATE_TEST_CASE("the earlier of two stopping events in one step ends the phase, whatever its index", "",
                   ALL_METHODS) {
    for (const int early : {0, 1, 2}) {
        std::array<function, 3> f{time(0.8), time(0.8), time(0.8)};
        f[static_cast<std::size_t>(early)] = time(0.3);
        auto e = ensemble_of(drift, f, 0, 1);
        auto o = options_for(1e-12, 1);
        for (auto& event : o.events) event.stop_after = 1;
        solve<TestType>(e, o);
        CHECK(order_of(log_of(e)) == std::vector<int>{early});
        CHECK(std::abs(e.t()[0] - 0.3) <= 1e-12);
        CHECK(std::abs(e.state(logged_motion::x)[0] - 0.3) <= 1e-12);
    }
}

TEMPLATE_TEST_CASE("an action may end the phase or the instance", "", ALL_METHODS) {
    for (const int what : {logged_motion::end_phase, logged_motion::end_instance}) {
        auto e = ensemble_of(drift, {position(0.5, what), never(), never()}, 0, 1);
        auto o = options_for(1e-12, 0.1);
        o.phases = 3;
        o.phase_time = myriad::phase_time::carry_on;
        solve<TestType>(e, o);
        CHECK(count_of(e) == 1);
        CHECK(e.phases_done()[0] == (what == logged_motion::end_phase ? 3 : 1));
        CHECK(e.t()[0] == (what == logged_motion::end_phase ? 1 : times_of(e)[0]));
        CHECK(e.status(0) ==
              (what == logged_motion::end_phase ? myriad::status::success : myriad::status::stopped_by_user));
    }
}

TEMPLATE_TEST_CASE("only the action of the event that fired runs", "", ALL_METHODS) {
    for (const int firing_event : {0, 1, 2}) {
        for (const int acting : {0, 1, 2}) {
            CAPTURE(firing_event, acting);
            std::array<function, 3> f{never(), never(), never()};
            f[static_cast<std::size_t>(firing_event)] = time(0.5);
            f[static_cast<std::size_t>(acting)].action = logged_motion::jump_v;
            auto e = ensemble_of(drift, f, 0, 1);
            solve<TestType>(e, options_for(1e-12, 0.1));
            CHECK(e.state(logged_motion::v)[0] == (firing_event == acting ? 2.0 : 1.0));
            CHECK(count_of(e) == 1);
        }
    }
}

TEMPLATE_TEST_CASE("an impact reverses the velocity by the law of restitution and leaves the position", "",
                   ALL_METHODS) {
    auto e = ensemble_of(motion{.x = 1, .v = -2}, {position(0, logged_motion::bounce), never(), never()}, 0, 1, 0.7);
    solve<TestType>(e, options_for(1e-12, 0.1));
    CHECK(std::abs(e.state(logged_motion::v)[0] - 1.4) <= 1e-15);
    CHECK(std::abs(e.state(logged_motion::x)[0] - 0.5 * 1.4) <= 3e-12);  // 1e-12 in x at the impact, twice
}

TEMPLATE_TEST_CASE("a quantity reset to zero by its own action fires again at the next true crossing only", "",
                   ALL_METHODS) {
    auto e = ensemble_of(sine, {position(0, logged_motion::zero_x), never(), never()}, 0, 13);
    solve<TestType>(e, options_for(1e-10, 1e-3));
    CHECK(agree(times_of(e), {pi, 2 * pi, 3 * pi, 4 * pi}, 1e-9));

    auto once = ensemble_of(motion{.x = -0.5, .v = 1}, {position(0, logged_motion::zero_x), never(), never()}, 0, 10);
    solve<TestType>(once, options_for(1e-10, 0.1));
    CHECK(agree(times_of(once), {0.5}, 1e-9));
}

TEMPLATE_TEST_CASE("a quantity moved back by its own action fires every time it comes by", "", ALL_METHODS) {
    auto e = ensemble_of(motion{.x = 0.5, .v = 1}, {position(1, logged_motion::lower_x), never(), never()}, 0, 5);
    solve<TestType>(e, options_for(1e-10, 0.1));
    CHECK(agree(times_of(e), {0.5, 1.5, 2.5, 3.5, 4.5}, 1e-9));
    CHECK(e.status(0) == myriad::status::success);
}

TEMPLATE_TEST_CASE("a quantity that jumps across zero by an action does not fire, but its next true crossing does", "",
                   ALL_METHODS) {
    // x goes from 0.5 to 1, falls back to 0 and passes 0.25 upwards each time, never downwards but by the jump
    auto e =
        ensemble_of(motion{.x = 0.5, .v = 1}, {position(1, logged_motion::lower_x), position(0.25), never()}, 0, 3.4);
    solve<TestType>(e, options_for(1e-10, 0.1));
    CHECK(agree(times_of(e, 0), {0.5, 1.5, 2.5}, 1e-9));
    CHECK(agree(times_of(e, 1), {0.75, 1.75, 2.75}, 1e-9));
}

TEMPLATE_TEST_CASE("a quantity that another event's action puts on the surface fires at its next true crossing", "",
                   ALL_METHODS) {
    // at t = 0.2 x is set to 0 from -0.8, and rises from there; it falls through 0 again at 0.2 + 2 v / |a|
    auto e =
        ensemble_of(motion{.x = -1, .v = 1, .a = -0.5}, {position(), time(0.2, logged_motion::zero_x), never()}, 0, 6);
    solve<TestType>(e, options_for(1e-10, 0.1));
    CHECK(times_of(e, 1).size() == 1);
    CHECK(agree(times_of(e, 0), {0.2 + 2 * 0.9 / 0.5}, 1e-9));
}

TEMPLATE_TEST_CASE("events without hooks' options use the defaults for all of them", "", ALL_METHODS) {
    auto e = ensemble_of(sine, {position(), velocity(), never()}, 0, 7);
    auto o = options_for(1, 1e-3);
    o.events.clear();  // either direction, 1e-6, never stopping
    solve<TestType>(e, o);
    CHECK(agree(times_of(e, 0), {pi, 2 * pi}, 1.1e-6));
    CHECK(agree(times_of(e, 1), {pi / 2, 3 * pi / 2}, 1.1e-6));
}

TEST_CASE("fixed steps go on with their step from the event") {
    auto e = ensemble_of(drift, {time(0.25), never(), never()}, 0, 1.05);
    solve<myriad::runge_kutta_4>(e, options_for(1e-12, 0.1));
    // 0.1, 0.2, 0.25, 0.35, ..., 1.05; on the old grid there would be one more, 1.0 and 1.05
    CHECK(e.accepted_steps()[0] == 11);
    CHECK(e.t()[0] == 1.05);
}

TEST_CASE("an event at the end of a fixed step costs no step") {
    auto e = ensemble_of(drift, {time(0.25), never(), never()}, 0, 1);
    solve<myriad::runge_kutta_4>(e, options_for(1e-12, 0.125));
    CHECK(e.accepted_steps()[0] == 8);
    CHECK(agree(times_of(e), {0.25}, 0));
}

TEMPLATE_TEST_CASE("adaptive steps go on with the size they had before the event", "", myriad::cash_karp,
                   myriad::tsitouras_5) {
    auto with = ensemble_of(sine, {position(), never(), never()}, 0, 13);
    auto without = ensemble_of(sine, {never(), never(), never()}, 0, 13);
    solve<TestType>(with, options_for(1e-10, 0.01));
    solve<TestType>(without, options_for(1e-10, 0.01));
    // four events cut four steps in two; restarting with a small step size would take several steps each time
    CHECK(with.accepted_steps()[0] - without.accepted_steps()[0] <= 8);
}

TEMPLATE_TEST_CASE("a located event costs few redone steps", "", ALL_METHODS) {
    auto e = ensemble_of(sine, {position(), never(), never()}, 0, 13);
    solve<TestType>(e, options_for(1e-10, 0.05));
    REQUIRE(count_of(e) == 4);
    CHECK(e.located_steps()[0] <= 4 * 10);  // design.md 5: at most ten redone steps each
}
