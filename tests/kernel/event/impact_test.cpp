// SPDX-License-Identifier: MIT
// Impacts with a law of restitution: times against the closed form, accumulation, and that no ball passes the floor.
#include "tests/catch.hpp"
#include "tests/kernel/event/logged_motions.hpp"
#include "tests/kernel/event/time_models.hpp"
#include "tests/support/device.hpp"

using namespace logged_motions;

namespace {

constexpr double gravity = 9.81, height = 1, restitution = 0.9;
constexpr double impact_tolerance = 1e-12;
const double accumulation = 8.5789491787288872;  // reference/values.md

// t_n = t1 + 2 t1 e (1 - e^(n-1)) / (1 - e)
double impact_time(int n) {
    const double t1 = std::sqrt(2 * height / gravity);
    return t1 + 2 * t1 * restitution * (1 - std::pow(restitution, n - 1)) / (1 - restitution);
}

auto ball(double t_end) {
    return ensemble_of(motion{.x = height, .a = -gravity}, {position(0, logged_motion::bounce), never(), never()}, 0,
                       t_end, restitution);
}

myriad::options ball_options(double step) {
    myriad::options o = options_for(impact_tolerance, step, myriad::direction::falling);
    return o;
}

}  // namespace

TEMPLATE_TEST_CASE("impacts 1 to 20 of a bouncing ball agree with the closed form to 1e-10", "", ALL_ORDERS) {
    auto e = ball(7.55);  // between impacts 20 and 21
    const auto report = solve<TestType>(e, ball_options(0.01));
    CHECK(report.count(myriad::status::success) == 1);
    const auto times = times_of(e);
    REQUIRE(times.size() == 20);
    for (int n = 1; n <= 20; ++n) {
        CAPTURE(n);
        CHECK(std::abs(times[static_cast<std::size_t>(n - 1)] - impact_time(n)) <= 1e-10);
    }
    CHECK(std::abs(times[0] - 0.45152364098573090445) <= 1e-10);
    CHECK(std::abs(times[1] - 1.2642661947600465) <= 1e-10);
    CHECK(std::abs(times[4] - 3.2465452834156023) <= 1e-10);
    CHECK(std::abs(times[9] - 5.4302180025853456) <= 1e-10);
    CHECK(std::abs(times[19] - 7.4810545039369188) <= 1e-10);
}

TEMPLATE_TEST_CASE("impacts that accumulate end the instance as event_accumulation at the right time", "",
                   ALL_METHODS) {
    for (const double step : {1e-3, 0.01, 0.1, 1.0}) {  // flights become shorter than any of them
        CAPTURE(step);
        auto e = ball(20);
        const auto report = solve<TestType>(e, ball_options(step));
        CHECK(report.count(myriad::status::event_accumulation) == 1);
        // flights below the event tolerance last less than 1e-5; most of the 50 that follow are counted
        CHECK(std::abs(e.t()[0] - accumulation) <= 1e-6);
        CHECK(e.accessory(logged_motion::smallest_x)[0] >= -impact_tolerance);
        CHECK(e.state(logged_motion::x)[0] >= -impact_tolerance);
        CHECK(std::abs(e.state(logged_motion::x)[0]) <= impact_tolerance);
        CHECK(std::isfinite(e.state(logged_motion::v)[0]));
    }
}

TEMPLATE_TEST_CASE("the limit of impacts is announced early by the flights that are left", "", ALL_METHODS) {
    for (const double kept : {0.3, 0.9, 0.99}) {
        for (const double tolerance : {1e-6, 1e-12}) {
            for (const std::int64_t limit : {10, 50, 200}) {
                CAPTURE(kept, tolerance, limit);
                auto e = ensemble_of(motion{.x = height, .a = -gravity},
                                     {position(0, logged_motion::bounce), never(), never()}, 0, 200, kept);
                auto o = options_for(tolerance, 0.01, myriad::direction::falling);
                o.accumulation_limit = limit;
                solve<TestType>(e, o);
                CHECK(e.status(0) == myriad::status::event_accumulation);
                const double rest = std::sqrt(2 * height / gravity) * (1 + kept) / (1 - kept);
                const double left = 2 * e.state(logged_motion::v)[0] / (gravity * (1 - kept));
                if (tolerance < 1e-9) CHECK(std::abs(e.t()[0] + left - rest) <= 1e-9);
                // An impact is found within the tolerance of zero, so that a flight within the tolerance may rise by
                // twice as much.
                const double most = std::sqrt(16 * tolerance / gravity) * std::pow(kept, limit - 1) / (1 - kept);
                CHECK(std::abs(left) <= most * 1.01 + 1e-12);
            }
        }
    }
}

TEMPLATE_TEST_CASE("impacts that accumulate over phases that end at maxima do not let the ball through the floor", "",
                   ALL_METHODS) {
    for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
        for (const bool one_call : {true, false}) {
            CAPTURE(tolerance, one_call);
            auto e = ensemble_of(motion{.x = height, .a = -gravity},
                                 {position(0, logged_motion::bounce), velocity(), never()}, 0, 20, 0.8);
            auto o = options_for(tolerance, 0.01, myriad::direction::falling);
            o.events[1].stop_after = 1;
            o.phase_time = myriad::phase_time::carry_on;
            o.phases = one_call ? 300 : 1;
            for (int call = 0; call < (one_call ? 1 : 300); ++call) solve<TestType>(e, o);
            CHECK(e.status(0) == myriad::status::event_accumulation);
            CHECK(e.accessory(logged_motion::smallest_x)[0] >= -tolerance);
            CHECK(std::abs(e.t()[0] - std::sqrt(2 * height / gravity) * 1.8 / 0.2) <= 10 * std::sqrt(tolerance));
        }
    }
}

TEMPLATE_TEST_CASE("the limit of accumulating impacts is an option", "", ALL_METHODS) {
    std::vector<int> counts;
    for (const std::int64_t limit : {1, 2, 50, 100}) {
        auto e = ball(20);
        auto o = ball_options(0.01);
        o.accumulation_limit = limit;
        solve<TestType>(e, o);
        CHECK(e.status(0) == myriad::status::event_accumulation);
        counts.push_back(count_of(e));
    }
    CHECK(counts[0] == 1);  // the first impact is one action already
    // from the first flight that stays within the tolerance on, every impact counts
    CHECK(counts[2] - counts[1] == 48);
    CHECK(counts[3] - counts[2] == 50);
}

TEMPLATE_TEST_CASE("flights shorter than the resolution of time do not let the ball through the floor", "",
                   ALL_METHODS) {
    // The later the time, and the less speed is left, the sooner a flight is too short for t to advance.
    for (const double t_begin : {0.0, 1e3, 1e6}) {
        for (const double kept : {0.8, 0.5, 0.1, 1e-3}) {
            for (const double tolerance : {1e-6, 1e-12}) {
                for (const std::int64_t limit : {50, 1000}) {
                    CAPTURE(t_begin, kept, tolerance, limit);
                    auto e = ensemble_of(motion{.x = height, .a = -gravity},
                                         {position(0, logged_motion::bounce), never(), never()}, t_begin, t_begin + 20,
                                         kept);
                    auto o = options_for(tolerance, 0.01, myriad::direction::falling);
                    o.accumulation_limit = limit;
                    solve<TestType>(e, o);
                    CHECK(e.status(0) == myriad::status::event_accumulation);
                    CHECK(e.accessory(logged_motion::smallest_x)[0] >= -tolerance);
                    CHECK(e.t()[0] < t_begin + 10);
                }
            }
        }
    }
}

TEMPLATE_TEST_CASE("a ball without restitution comes to rest on the floor and does not fall through it", "",
                   ALL_METHODS) {
    auto e = ensemble_of(motion{.x = height, .a = -gravity}, {position(0, logged_motion::bounce), never(), never()}, 0,
                         20, 0.0);
    const auto report = solve<TestType>(e, ball_options(0.01));
    CHECK(report.count(myriad::status::event_accumulation) == 1);
    // it may sink from a tolerance above the floor to a tolerance below it, for 2 sqrt(tol / g), before each impact
    CHECK(std::abs(e.t()[0] - impact_time(1)) <= 50 * 2 * std::sqrt(impact_tolerance / gravity));
    CHECK(e.accessory(logged_motion::smallest_x)[0] >= -impact_tolerance);
}

TEMPLATE_TEST_CASE("balls that bounce for a long time never pass the floor by more than the tolerance", "",
                   ALL_METHODS) {
    std::vector<motion> starts;
    for (int i = 0; i < 100; ++i) starts.push_back({.x = 0.01 * (i + 1), .v = 0.1 * (i % 7 - 3), .a = -1 - 0.2 * i});
    auto e = ensemble_of(starts, {position(0, logged_motion::bounce), never(), never()}, 0, 3, 0.8);
    solve<TestType>(e, options_for(1e-9, 0.05));
    for (Eigen::Index i = 0; i < e.size(); ++i) {
        CAPTURE(i);
        CHECK(e.accessory(logged_motion::smallest_x)[i] >= -1e-9);
        CHECK((e.status(i) == myriad::status::success || e.status(i) == myriad::status::event_accumulation));
        CHECK(count_of(e, i) > 0);
    }
}

TEMPLATE_TEST_CASE("a ball between two walls hits them in turn", "", ALL_METHODS) {
    auto e = ensemble_of(motion{.x = 0.25, .v = 1},
                         {position(0, logged_motion::bounce), position(1, logged_motion::bounce), never()}, 0, 5);
    const auto report = solve<TestType>(e, options_for(1e-10, 0.1));
    CHECK(report.count(myriad::status::success) == 1);
    // straight flights: each impact's error is at most the tolerance over the speed, 1
    CHECK(agree(times_of(e, 1), {0.75, 2.75, 4.75}, 1e-9));
    CHECK(agree(times_of(e, 0), {1.75, 3.75}, 1e-9));
}

TEMPLATE_TEST_CASE("impacts that a step happens to end on are not taken for accumulating ones", "", ALL_METHODS) {
    // 200 impacts two units of time apart; every step of 0.25 that ends on a wall is exact
    for (const double step : {0.25, 0.07}) {
        CAPTURE(step);
        auto e = ensemble_of(
            motion{.v = 1}, {position(1, logged_motion::bounce), position(-1, logged_motion::bounce), never()}, 0, 400);
        auto o = options_for(1e-6, step);
        o.maximum_step = step;
        solve<TestType>(e, o);
        CHECK(e.status(0) == myriad::status::success);
        CHECK(count_of(e) == 200);
        CHECK(e.t()[0] == 400);
    }
}

TEMPLATE_TEST_CASE("impacts far from t = 0 take no time from the flights between them", "", ALL_METHODS) {
    // 137 impacts on walls two units apart; with a resolution of t of 1e-7, each would lose about half of that
    constexpr double speed = 1.1, flight = 249;
    for (const double t_begin : {0.0, 1e6, 1e9}) {
        CAPTURE(t_begin);
        auto e = ensemble_of(motion{.v = speed},
                             {position(1, logged_motion::bounce), position(-1, logged_motion::bounce), never()},
                             t_begin, t_begin + flight);
        solve<TestType>(e, options_for(1e-12, 0.1));
        CHECK(e.status(0) == myriad::status::success);
        REQUIRE(count_of(e) == 137);
        // the 137th was on the upper wall; the error of an impact within its tolerance doubles for all that follow
        CHECK(std::abs(e.state(logged_motion::x)[0] - (2 * 137 - speed * flight)) <= 2 * 137 * 2e-12);
    }
}

TEMPLATE_TEST_CASE("the period of a pendulum is right to 1e-10", "", ALL_METHODS) {
    myriad::ensemble<pendulum> e(1);
    e.state(pendulum::x) = 0.05;
    e.state(pendulum::v) = 0;
    e.time_domain(0, 2.5);
    myriad::options o;
    o.relative_tolerance = 1e-13;
    o.absolute_tolerance = 1e-13;
    o.step = 1e-3;  // RK4: (omega h)^4 / 120 over 2 pi is 5e-12 of the period
    // v passes zero with a slope of 0.49: 1e-12 in v are 2e-12 in t
    o.events = {{.direction = myriad::direction::falling, .tolerance = 1e-12}};
    myriad::solve<TestType>(tests::test_device(1), e, o);
    REQUIRE(e.integer_accessory(pendulum::fired)[0] == 1);  // and not at the start, which is a turning point too
    CHECK(std::abs(e.accessory(0)[0] - 2.0074035758801301205) <= 1e-10);
}
