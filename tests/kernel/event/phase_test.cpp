// SPDX-License-Identifier: MIT
// Events where phases and calls end: each crossing fires exactly once, and a loop on the host gives the same bits as
// phases in one call.
#include "tests/catch.hpp"
#include "tests/kernel/event/time_models.hpp"
#include "tests/kernel/event/watching.hpp"
#include "tests/support/device.hpp"

using namespace watching;

namespace {

bool same_results(const myriad::ensemble<watch>& a, const myriad::ensemble<watch>& b) {
    bool same = true;
    const auto compare = [&](const auto& x, const auto& y) { same = same && (x == y).all(); };
    for (int c = 0; c < watch::n_state; ++c) compare(a.state(c), b.state(c));
    for (int c = 0; c < watch::at; ++c) compare(a.accessory(c), b.accessory(c));
    for (int c = 0; c < watch::n_integer_accessory; ++c) compare(a.integer_accessory(c), b.integer_accessory(c));
    compare(a.t(), b.t());
    compare(a.phases_done(), b.phases_done());
    compare(a.accepted_steps(), b.accepted_steps());
    compare(a.rejected_steps(), b.rejected_steps());
    compare(a.located_steps(), b.located_steps());
    compare(a.rhs_evaluations(), b.rhs_evaluations());
    for (std::int64_t i = 0; i < a.size(); ++i) same = same && a.status(i) == b.status(i);
    return same;
}

}  // namespace

TEMPLATE_TEST_CASE("every crossing fires once wherever the phases end", "", ALL_METHODS) {
    // x = t - 1: phases that end before, on and after the root by fractions of the tolerance
    constexpr double tolerance = 1e-3;
    for (const double short_of : {-2.0, -1.0, -0.7, -0.3, 0.0, 0.3, 0.7, 1.0, 2.0}) {
        for (const auto time : {myriad::phase_time::restart, myriad::phase_time::carry_on}) {
            CAPTURE(short_of, static_cast<int>(time));
            const double first_end = 1 - short_of * tolerance;
            auto e = ensemble_of(motion{.x = -1, .v = 1}, {position(), never(), never()}, 0, first_end);
            auto o = options_for(tolerance, 0.1);
            o.phase_time = time;
            solve<TestType>(e, o);
            const int by_then = count_of(e);
            CHECK(by_then == (short_of <= 0 ? 1 : 0));  // at t_end only functions at or past zero
            e.t_end() = time == myriad::phase_time::restart ? 1 : first_end + 1;
            solve<TestType>(e, o);
            CHECK(count_of(e) == 1);
            solve<TestType>(e, o);
            CHECK(count_of(e) == 1);
        }
    }
}

TEMPLATE_TEST_CASE("a crossing within rounding of the end of a phase fires once", "", ALL_METHODS) {
    for (const double late : {-1e-12, -1e-14, -3e-16, 0.0, 3e-16, 1e-14, 1e-12}) {
        for (const double step : {1.0 / 7, 0.01, 0.003}) {
            for (const bool one_call : {false, true}) {
                CAPTURE(late, step, one_call);
                auto e = ensemble_of(motion{.x = -1, .v = 1}, {position(), never(), never()}, 0, 1 + late);
                auto o = options_for(1e-6, step);
                o.maximum_step = step;
                o.phase_time = myriad::phase_time::carry_on;
                solve<TestType>(e, o);
                CHECK((late < 0 || count_of(e) == 1));
                e.t_end() = 2;
                o.phases = one_call ? 2 : 1;
                solve<TestType>(e, o);
                CHECK(agree(times_of(e), {1}, 1e-6));
            }
        }
    }
}

TEMPLATE_TEST_CASE("the host may turn the flow round between phases that stop on the surface", "", ALL_METHODS) {
    // A ball dropped from one: impacts at sqrt(2) (1, 3, 5, 7), whose law the host applies.
    for (const auto d : {myriad::direction::either, myriad::direction::falling}) {
        for (const auto step : {myriad::phase_step::restart, myriad::phase_step::carry_on}) {
            CAPTURE(static_cast<int>(d), static_cast<int>(step));
            auto e = ensemble_of(motion{.x = 1, .a = -1}, {position(), never(), never()}, 0, 20);
            auto o = options_for(1e-9, 1e-2, d);
            o.events[0].stop_after = 1;
            o.phase_time = myriad::phase_time::carry_on;
            o.phase_step = step;
            for (int impact = 0; impact < 4; ++impact) {
                solve<TestType>(e, o);
                CHECK(e.status(0) == myriad::status::stopped_by_event);
                CHECK(std::abs(e.t()[0] - std::sqrt(2.0) * (2 * impact + 1)) < 1e-7);
                e.state(watch::x) = 0.0;
                e.state(watch::v) = -e.state(watch::v)[0];
            }
            CHECK(count_of(e) == 4);
        }
    }
}

TEMPLATE_TEST_CASE("a phase that stops on its event does not find it again in the next", "", ALL_METHODS) {
    for (const double tolerance : {1e-3, 1e-6, 1e-12}) {
        auto e = ensemble_of(sine, {position(), never(), never()}, 0, 100);
        auto o = options_for(tolerance, 1e-3);
        o.events[0].stop_after = 1;
        o.phases = 8;
        o.phase_time = myriad::phase_time::carry_on;
        solve<TestType>(e, o);
        std::vector<double> expected;
        for (int n = 1; n <= 8; ++n) expected.push_back(n * pi);
        CHECK(agree(times_of(e), expected, 1.1 * tolerance + 1e-9));
        CHECK(e.status(0) == myriad::status::stopped_by_event);
    }
}

TEMPLATE_TEST_CASE("an event that ended a phase does not end the next at its start, however closely it was located", "",
                   ALL_METHODS) {
    // Tops of swings, phase by phase; time starts anew in each, so that nothing shows how well it resolved the last.
    std::vector<motion> swings;
    for (int i = 0; i < 300; ++i) swings.push_back({.v = std::pow(10.0, -(i % 5)), .k = 0.5 + 0.005 * i});
    for (const double step : {1e-2, 1e-3}) {
        auto e = ensemble_of(swings, {velocity(), never(), never()}, 0, 20);
        auto o = options_for(0, step, myriad::direction::falling);
        o.relative_tolerance = 1e-9;
        o.events[0].stop_after = 1;
        o.phases = 3;
        solve<TestType>(e, o);
        int wrong = 0;
        for (int i = 0; i < static_cast<int>(swings.size()); ++i) {
            const double period = 2 * pi / std::sqrt(swings[static_cast<std::size_t>(i)].k);
            wrong += !agree(times_of(e, 0, i), {period / 4, period, period}, 1e-5);
        }
        CHECK(wrong == 0);
    }
}

TEMPLATE_TEST_CASE("a phase that another event stops within the tolerance of a crossing keeps it for the next", "",
                   ALL_METHODS) {
    constexpr double tolerance = 1e-3;
    for (const double offset : {-0.9e-3, -0.5e-3, 0.0, 0.5e-3, 0.9e-3}) {
        for (const double step : {0.1, 0.25, 2.0}) {
            CAPTURE(offset, step);
            auto e = ensemble_of(motion{.x = -1, .v = 1}, {position(), time(1 + offset), never()}, 0, 3);
            auto o = options_for(tolerance, step);
            o.events[1].tolerance = 1e-9;
            o.events[1].stop_after = 1;
            o.phases = 2;
            o.phase_time = myriad::phase_time::carry_on;
            solve<TestType>(e, o);
            CHECK(agree(times_of(e, 0), {1}, tolerance));
            CHECK(agree(times_of(e, 1), {1 + offset}, 1e-9));
            CHECK(e.t()[0] == 3);
        }
    }
}

TEMPLATE_TEST_CASE("crossings on the ends of many phases all fire once", "", ALL_METHODS) {
    // half a period per phase: every crossing of x is at a phase's end, up to the integration error
    auto e = ensemble_of(sine, {position(), velocity(), never()}, 0, pi);
    auto o = options_for(1e-7, 1e-3);
    o.phases = 7;
    solve<TestType>(e, o);
    const auto zeros = static_cast<int>(times_of(e, 0).size());
    CHECK((zeros == 7 || zeros == 6));  // the last may still be pending
    CHECK(times_of(e, 1).size() == 7);
    e.t_end() = 0.1;
    o.phases = 1;
    solve<TestType>(e, o);
    CHECK(times_of(e, 0).size() == 7);
}

TEMPLATE_TEST_CASE("a loop of calls gives the same bits as phases in one call", "", ALL_METHODS) {
    std::vector<motion> starts;
    for (int i = 0; i < 23; ++i) starts.push_back({.x = 0.1 * i, .v = 1 - 0.05 * i, .a = -1, .k = 0.2 * i});
    const auto fresh = [&] {
        return ensemble_of(starts, {position(0, watch::bounce), velocity(), position(1)}, 0, 2.5, 0.8);
    };
    for (const double length : {0.0, 0.4}) {
        for (const auto step : {myriad::phase_step::restart, myriad::phase_step::carry_on}) {
            CAPTURE(length, static_cast<int>(step));
            auto o = options_for(1e-9, 0.01);
            o.relative_tolerance = o.absolute_tolerance = 1e-8;
            o.phase_length = length;
            o.phase_step = step;
            auto whole = fresh(), single = fresh(), uneven = fresh();
            o.phases = 6;
            solve<TestType>(whole, o);
            o.phases = 1;
            for (int n = 0; n < 6; ++n) solve<TestType>(single, o);
            for (const int n : {2, 3, 1}) {
                o.phases = n;
                solve<TestType>(uneven, o);
            }
            CHECK(count_of(whole, 5) > 2);
            CHECK(same_results(whole, single));
            CHECK(same_results(whole, uneven));
        }
    }
}

TEMPLATE_TEST_CASE("the number of detections starts anew in every phase", "", ALL_METHODS) {
    auto e = ensemble_of(sine, {position(), never(), never()}, 0, 7);  // two crossings per phase of 7 > 2 pi, or three
    auto o = options_for(1e-10, 1e-3);
    o.events[0].stop_after = 4;
    o.phases = 5;
    solve<TestType>(e, o);
    CHECK(e.status(0) == myriad::status::success);
    CHECK(count_of(e) == 11);  // 35 / pi
}

TEMPLATE_TEST_CASE("after restart an ensemble finds its events as at first", "", ALL_METHODS) {
    auto e = ensemble_of(sine, {position(), never(), never()}, 0, 7);
    solve<TestType>(e, options_for(1e-10, 1e-3));
    const auto first = times_of(e);
    e.restart();
    e.state(watch::x) = 0;
    e.state(watch::v) = 1;
    e.integer_accessory(watch::fired) = 0;
    solve<TestType>(e, options_for(1e-10, 1e-3));
    REQUIRE(times_of(e).size() == first.size());
    CHECK(agree(times_of(e), first, 0));
}

TEMPLATE_TEST_CASE("a state that the host puts on the surface between two calls does not fire there", "", ALL_METHODS) {
    auto e = ensemble_of(motion{.x = -1, .v = 1}, {position(), never(), never()}, 0, 0.5);
    solve<TestType>(e, options_for(1e-9, 0.1));
    CHECK(count_of(e) == 0);
    e.state(watch::x) = 0;
    solve<TestType>(e, options_for(1e-9, 0.1));
    CHECK(count_of(e) == 0);
}

TEMPLATE_TEST_CASE("a function of time that starts on its surface again in every phase does not fire there", "",
                   ALL_METHODS) {
    myriad::ensemble<wave> e(1);
    e.state(wave::x) = 1;
    e.parameter(wave::amplitude) = 1;  // cos t rises from -pi/2, falls through zero at pi/2, and ends below it
    e.parameter(wave::c) = 0;
    e.time_domain(-pi / 2, 2);
    myriad::options o;
    o.step = 0.05;
    o.maximum_step = 0.05;
    o.events = {{.tolerance = 1e-9}};
    o.phases = 3;
    myriad::solve<TestType>(tests::test_device(1), e, o);
    REQUIRE(e.integer_accessory(wave::fired)[0] == 3);
    for (int k = 0; k < 3; ++k) CHECK(std::abs(e.accessory(k)[0] - pi / 2) <= 1e-9);
}
