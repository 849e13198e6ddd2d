// SPDX-License-Identifier: MIT
// Stop times: steps end exactly there, actions run there once, and nothing else changes.
#include "myriad/kernel/event/stop_driver.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <myriad/myriad.hpp>
#include <myriad/tangent.hpp>

#include "tests/catch.hpp"
#include "tests/kernel/event/stop_models.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/device.hpp"

namespace {

using compare::fixed_step;
using compare::with_tolerance;
using myriad::ensemble;
using myriad::options;
using myriad::solve;
using myriad::status;
using stops::alone;
using stops::delayed;
using stops::dosed;
using stops::infused;
using stops::kicked;
using stops::listed;
using stops::prolonged;
using stops::squared;

constexpr double beyond = 1e6 - 1;  // of any domain here

/// Calls `test.operator()<Method>()` for fixed and for adaptive steps.
template <class Test>
void each_method(Test test) {
    {
        INFO("runge_kutta_4");
        test.template operator()<myriad::runge_kutta_4>();
    }
    {
        INFO("tsitouras_5");
        test.template operator()<myriad::tsitouras_5>();
    }
}

/// One instance that gets `doses` doses of 1, the first at `first`, then one every `interval`.
template <class Model = dosed>
ensemble<Model> treated(double first, double interval, int doses, double t_end, std::int64_t size = 1) {
    ensemble<Model> e(size);
    for (int c = 0; c < dosed::n_state; ++c) e.state(c) = 0.0;
    e.parameter(dosed::ka) = 1.5;
    e.parameter(dosed::ke) = 0.25;
    e.parameter(dosed::amount) = 1.0;
    e.parameter(dosed::first) = first;
    e.parameter(dosed::interval) = interval;
    e.parameter(dosed::doses) = static_cast<double>(doses);
    e.time_domain(0, t_end);
    return e;
}
/// The blood's content at t after doses of 1 at the given times (Bateman function).
double blood_at(double t, double first, double interval, int doses) {
    double sum = 0;
    for (int k = 0; k < doses; ++k) {
        const double since = t - (first + k * interval);
        if (since > 0) sum += 1.5 / (1.5 - 0.25) * (std::exp(-0.25 * since) - std::exp(-1.5 * since));
    }
    return sum;
}

/// One instance of `listed` with such stops, from 0 to t_end.
ensemble<listed> with_list(std::vector<double> times, double late, double t_end, double t_begin = 0) {
    ensemble<listed> e(1);
    e.state(0) = t_begin;
    for (int k = 0; k < 4; ++k) e.parameter(k) = times[static_cast<std::size_t>(k)];
    e.parameter(listed::late) = late;
    e.time_domain(t_begin, t_end);
    return e;
}
std::int32_t code_of(const ensemble<listed>& e) { return e.integer_accessory(listed::code)[0]; }

}  // namespace

TEST_CASE("actions run at the very stop times, by every method") {
    const auto check = []<class Method>() {
        // times that steps of 1/64 would not meet
        auto e = treated(0.3, 0.7, 5, 5);
        solve<Method>(tests::test_device(), e, with_tolerance(1e-9));
        REQUIRE(e.status(0) == status::success);
        CHECK(e.integer_accessory(dosed::given)[0] == 5);
        CHECK(e.integer_accessory(dosed::last_number)[0] == 4);
        for (int k = 0; k < 5; ++k) CHECK(e.accessory(k)[0] == std::fma(k, 0.7, 0.3));
        CHECK(e.t()[0] == 5.0);
        // Runge-Kutta 4 with h = 1/64: (1.5 h)^5 / 120 per step; the others by their tolerance
        CHECK(std::abs(e.state(dosed::blood)[0] - blood_at(5, 0.3, 0.7, 5)) < 1e-7);
    };
    each_method(check);
    INFO("rodas_5p");
    check.operator()<myriad::rodas_5p>();
}
TEST_CASE("in single precision stop times are the nearest numbers to those given") {
    ensemble<dosed, float> e(1);
    for (int c = 0; c < dosed::n_state; ++c) e.state(c) = 0.0f;
    const float parameters[] = {1.5f, 0.25f, 1.0f, 0.3f, 0.7f, 5.0f};
    for (int c = 0; c < dosed::n_parameter; ++c) e.parameter(c) = parameters[c];
    e.time_domain(0, 5);
    options o = with_tolerance(1e-5);
    solve<myriad::tsitouras_5>(tests::test_device(), e, o);
    for (int k = 0; k < 5; ++k) CHECK(e.accessory(k)[0] == std::fma(static_cast<float>(k), 0.7f, 0.3f));
    CHECK(std::abs(static_cast<double>(e.state(dosed::blood)[0]) - blood_at(5, 0.3, 0.7, 5)) < 1e-4);
}
TEST_CASE("a phase that begins or ends at a stop time runs its action once") {
    each_method([]<class Method> {
        SECTION("at its start") {
            auto e = treated(0, 1, 1, 2);
            solve<Method>(tests::test_device(), e, with_tolerance(1e-9));
            CHECK(e.integer_accessory(dosed::given)[0] == 1);
            CHECK(e.accessory(0)[0] == 0.0);
            CHECK(std::abs(e.state(dosed::gut)[0] - std::exp(-3.0)) < 1e-7);
        }
        SECTION("at its end") {
            auto e = treated(2, 1, 5, 2);
            solve<Method>(tests::test_device(), e, with_tolerance(1e-9));
            CHECK(e.integer_accessory(dosed::given)[0] == 1);
            CHECK(e.state(dosed::gut)[0] == 1.0);
        }
        SECTION("of no length") {
            auto e = treated(2, 1, 5, 2);
            e.time_domain(2, 2);
            solve<Method>(tests::test_device(), e, with_tolerance(1e-9));
            CHECK(e.integer_accessory(dosed::given)[0] == 1);
            CHECK(e.state(dosed::gut)[0] == 1.0);
        }
    });
}
TEST_CASE("phases that carry on run each action once, and phases that start again run all of theirs") {
    each_method([]<class Method> {
        auto e = treated(0, 0.5, 100, 4);  // also where two phases meet
        options o = with_tolerance(1e-9);
        o.phase_length = 1;
        o.phases = 3;
        solve<Method>(tests::test_device(), e, o);
        CHECK(e.integer_accessory(dosed::given)[0] == 7);
        o.phases = 1;  // in a call of its own
        solve<Method>(tests::test_device(), e, o);
        CHECK(e.integer_accessory(dosed::given)[0] == 9);
        CHECK(std::abs(e.state(dosed::blood)[0] - blood_at(4, 0, 0.5, 9)) < 1e-7);

        auto again = treated(0, 0.5, 100, 1);
        options restarted = with_tolerance(1e-9);
        restarted.phases = 3;
        solve<Method>(tests::test_device(), again, restarted);
        CHECK(again.integer_accessory(dosed::given)[0] == 9);
    });
}
TEST_CASE("stops in the past, beyond the end and without a number are none, and those at one time all count") {
    each_method([]<class Method> {
        const auto run = [](std::vector<double> times, double late, double t_begin = 0) {
            auto e = with_list(times, late, 5, t_begin);
            solve<Method>(tests::test_device(), e, with_tolerance(1e-9, 1.0 / 8));
            CHECK(e.status(0) == status::success);
            CHECK(e.t()[0] == 5.0);
            return code_of(e);
        };
        CHECK(run({-3, -2, 1, 7}, beyond) == 1);
        CHECK(run({0.5, 1, 2, 3}, 4, 1.5) == 112);
        CHECK(run({1, 1, 1, 2}, 1) == 12111);  // the next of each kind, in order of the kinds
        CHECK(run({0, 0, 5, 5}, 5) == 11121);
        CHECK(run({1, listed::no_number, 2, 3}, 4) == 12);
        CHECK(run({listed::minus, 1, 2, 3}, 4) == 2);
        CHECK(run({beyond, beyond, beyond, beyond}, listed::no_number) == 0);
    });
}
TEST_CASE("an action ends the phase or the instance after the others at its time") {
    each_method([]<class Method> {
        const auto run = [](int end_at, int end_how, std::int64_t phases) {
            auto e = with_list({1, 1, 2, 3}, 1, 5);
            e.shared_integer(listed::end_at) = end_at;
            e.shared_integer(listed::end_how) = end_how;
            options o = with_tolerance(1e-9, 1.0 / 8);
            o.phases = phases;
            o.phase_length = 5;
            solve<Method>(tests::test_device(), e, o);
            return e;
        };
        const auto phase = run(1, 1, 1);
        CHECK(phase.status(0) == status::stopped_by_user);
        CHECK(phase.t()[0] == 1.0);
        CHECK(code_of(phase) == 121);
        CHECK(phase.phases_done()[0] == 1);
        const auto next = run(1, 1, 2);
        CHECK(next.status(0) == status::success);
        CHECK(next.t()[0] == 5.0);
        CHECK(code_of(next) == 12111);
        const auto instance = run(1211, 2, 3);
        CHECK(instance.t()[0] == 2.0);
        CHECK(instance.phases_done()[0] == 1);

        // at the start, before the first step
        auto e = with_list({0, 2, 3, 4}, beyond, 5);
        e.shared_integer(listed::end_at) = 1;
        e.shared_integer(listed::end_how) = 1;
        solve<Method>(tests::test_device(), e, with_tolerance(1e-9, 1.0 / 8));
        CHECK(e.status(0) == status::stopped_by_user);
        CHECK(e.t()[0] == 0.0);
        CHECK(e.accepted_steps()[0] == 0);
    });
}
TEST_CASE("too many stops at one time end the instance as event_accumulation") {
    auto e = treated(1, 0, 1000, 2);
    options o = with_tolerance(1e-9);
    solve<myriad::tsitouras_5>(tests::test_device(), e, o);
    CHECK(e.status(0) == status::event_accumulation);
    CHECK(e.t()[0] == 1.0);
    CHECK(e.integer_accessory(dosed::given)[0] == 50);

    auto allowed = treated(1, 0, 1000, 2);
    o.accumulation_limit = 2000;
    solve<myriad::tsitouras_5>(tests::test_device(), allowed, o);
    CHECK(allowed.status(0) == status::success);
    CHECK(allowed.integer_accessory(dosed::given)[0] == 1000);
}
TEST_CASE("a hundred thousand doses are given, each at its time") {
    each_method([]<class Method> {
        constexpr int doses = 100'000;
        auto e = treated(0.1, 0.3, doses, 0.1 + 0.3 * doses);
        options o = with_tolerance(1e-6, 0.125);
        o.max_steps = 1'000'000;
        solve<Method>(tests::test_device(), e, o);
        REQUIRE(e.status(0) == status::success);
        CHECK(e.integer_accessory(dosed::given)[0] == doses);
        // the last interval of the periodic solution; the first doses are forgotten
        CHECK(std::abs(e.state(dosed::gut)[0] - std::exp(-0.45) / (1 - std::exp(-0.45))) < 1e-4);

        // a phase that begins late finds its first dose
        auto late = treated(0.1, 0.3, doses, 0);
        late.time_domain(0.1 + 0.3 * (doses - 2.5), 0.1 + 0.3 * doses);
        solve<Method>(tests::test_device(), late, with_tolerance(1e-6, 0.125));
        CHECK(late.integer_accessory(dosed::given)[0] == 2);
        CHECK(late.integer_accessory(dosed::last_number)[0] == doses - 1);
    });
}
TEST_CASE("steps that would end within rounding of a stop end at it, and no step is shorter for that") {
    each_method([]<class Method> {
        // 0.1 + 0.1 + ... meets no multiple of 0.3 exactly
        auto stopped = treated(0.3, 0.3, 100, 30);
        auto free = treated(beyond, 1, 1, 30);
        solve<Method>(tests::test_device(), stopped, fixed_step(0.1));
        solve<Method>(tests::test_device(), free, fixed_step(0.1));
        CHECK(free.accepted_steps()[0] == 300);
        CHECK(stopped.accepted_steps()[0] == 300);
        CHECK(stopped.integer_accessory(dosed::given)[0] == 100);
    });
}
TEST_CASE("after a stop adaptive steps are as long as they would have been") {
    // a stop right behind another: the step between them says nothing of the next
    auto e = with_list({1, 1 + 1e-9, beyond, beyond}, beyond, 100);
    options o = with_tolerance(1e-9, 1);
    o.maximum_step = 10;
    solve<myriad::tsitouras_5>(tests::test_device(), e, o);
    CHECK(code_of(e) == 11);
    CHECK(e.accepted_steps()[0] <= 16);  // 1, to the second stop, 5, and nine of 10
    CHECK(e.rejected_steps()[0] == 0);
}
TEST_CASE("backwards in time stops are met in the order of their numbers") {
    each_method([]<class Method> {
        auto e = with_list({4, 3, 3, 1}, 2, 0, 5);
        solve<Method>(tests::test_device(), e, with_tolerance(1e-9, 1.0 / 8));
        CHECK(code_of(e) == 11121);
        CHECK(e.t()[0] == 0.0);
        CHECK(std::abs(e.state(0)[0]) < 1e-12);

        auto passed = with_list({7, 6, 5, 0}, listed::no_number, 0, 5);
        solve<Method>(tests::test_device(), passed, with_tolerance(1e-9, 1.0 / 8));
        CHECK(code_of(passed) == 11);
    });
}
TEST_CASE("the right-hand side is as the action leaves it") {
    each_method([]<class Method> {
        ensemble<infused> e(1);
        e.state(0) = 0.0;
        e.parameter(infused::rate) = 0.0;
        e.parameter(infused::start) = 0.7;
        e.parameter(infused::finish) = 1.9;
        e.time_domain(0, 3);
        solve<Method>(tests::test_device(), e, with_tolerance(1e-10));
        // y' = 1 - y over 1.2, then y' = -y over 1.1; Runge-Kutta 4 with h = 1/64 within h^4 / 120
        CHECK(std::abs(e.state(0)[0] - (1 - std::exp(-1.2)) * std::exp(-1.1)) < 1e-9);
        CHECK(e.parameter(infused::rate)[0] == 0.0);
    });
}
TEST_CASE("a sample at a stop time, up to sixteen roundings, shows the state before the action") {
    each_method([]<class Method> {
        auto e = treated(0, 0.5, 4, 2);
        options o = with_tolerance(1e-9);
        o.samples.states = {dosed::gut};
        constexpr double rounding = std::numeric_limits<double>::epsilon();
        o.samples.times = {0, 0.25, 0.5, 0.5 + 8 * rounding, 0.5 + 9 * rounding, 1, 2, 2 + 32 * rounding};
        o.samples.capacity = 8;
        solve<myriad::dense<Method>>(tests::test_device(), e, o);
        const auto gut = e.samples().state(dosed::gut);
        REQUIRE(e.samples().stored()(0) == 8);
        const double left = std::exp(-0.75);  // of a dose after half a unit of time
        CHECK(gut(0, 0) == 0.0);
        CHECK(std::abs(gut(0, 1) - std::exp(-0.375)) < 1e-5);
        CHECK(std::abs(gut(0, 2) - left) < 1e-7);
        CHECK(gut(0, 3) == gut(0, 2));
        CHECK(std::abs(gut(0, 4) - (1 + left)) < 1e-7);
        CHECK(std::abs(gut(0, 5) - (1 + left) * left) < 1e-7);
        CHECK(std::abs(gut(0, 6) - (1 + left + left * left + left * left * left) * left) < 1e-7);
        CHECK(gut(0, 7) == gut(0, 6));  // at the end as at a stop
    });
}
TEST_CASE("an event sets a stop time, and the action follows it by the delay") {
    const auto check = []<class Model, class Method>() {
        for (const double delay : {0.0, 0.5, 1.25}) {
            CAPTURE(delay);
            ensemble<Model> e(1);
            e.state(0) = 0.0;
            e.parameter(delayed::level) = 1.0;
            e.parameter(delayed::delay) = delay;
            e.parameter(delayed::fall) = 10.0;
            e.time_domain(0, 5);
            solve<Method>(tests::test_device(), e, with_tolerance(1e-9, 0.3));
            CHECK(e.status(0) == status::success);
            CHECK(e.integer_accessory(delayed::events_seen)[0] == 1);
            CHECK(e.integer_accessory(delayed::actions)[0] == 1);
            CHECK(e.accessory(delayed::t_action)[0] == e.accessory(delayed::t_event)[0] + delay);
            CHECK(std::abs(e.state(0)[0] - (5 - 10)) < 1e-8);
        }
    };
    each_method([&]<class Method> {
        check.template operator()<delayed, Method>();
        check.template operator()<alone<delayed>, Method>();
    });
}
TEST_CASE("a stop whose time every event sets anew acts every time") {
    const auto check = []<class Model, class Method>() {
        // from 0 to 1, down by 1 half a unit later: events at 1, 2, ... 20, the last action beyond the end
        for (const int phases : {1, 7}) {
            CAPTURE(phases);
            ensemble<Model> e(1);
            e.state(0) = 0.0;
            e.parameter(delayed::level) = 1.0;
            e.parameter(delayed::delay) = 0.5;
            e.parameter(delayed::fall) = 1.0;
            e.time_domain(0, 20.25);
            options o = with_tolerance(1e-9, 0.3);
            o.phases = phases;
            if (phases > 1) o.phase_length = 20.25 / phases;
            solve<Method>(tests::test_device(), e, o);
            CHECK(e.status(0) == status::success);
            CHECK(e.integer_accessory(delayed::events_seen)[0] == 20);
            CHECK(e.integer_accessory(delayed::actions)[0] == 19);
            CHECK(std::abs(e.state(0)[0] - 1.25) < 1e-8);
        }
    };
    each_method([&]<class Method> {
        check.template operator()<delayed, Method>();
        check.template operator()<alone<delayed>, Method>();
    });
}
TEST_CASE("at a stop time events come first, and an action moves their functions without firing them") {
    const auto check = []<class Model, class Method>() {
        const auto run = [](double level, double time, double kick) {
            ensemble<Model> e(1);
            e.state(0) = 0.0;
            e.parameter(kicked::level) = level;
            e.parameter(kicked::time) = time;
            e.parameter(kicked::kick) = kick;
            e.time_domain(0, 5);
            options o = with_tolerance(1e-9, 0.25);
            o.events = {{.direction = myriad::direction::rising}};
            solve<Method>(tests::test_device(), e, o);
            CHECK(e.status(0) == status::success);
            return e.integer_accessory(kicked::code)[0];
        };
        CHECK(run(2, 1, 0) == 21);      // apart
        CHECK(run(2, 1, 3) == 2);       // across the surface
        CHECK(run(2, 3, -2.5) == 121);  // back, and the event happens again
        CHECK(run(2, 2, 0) == 12);      // at once
        CHECK(run(2, 2, 0.5) == 12);
        CHECK(run(2, 2, -1) == 121);
    };
    each_method([&]<class Method> {
        check.template operator()<kicked, Method>();
        check.template operator()<alone<kicked>, Method>();
    });
}
TEST_CASE("an action moves the end of its phase") {
    each_method([]<class Method> {
        for (const double time : {0.0, 1.0, 2.0}) {
            CAPTURE(time);
            ensemble<prolonged> e(1);
            e.state(0) = 1.0;
            e.parameter(prolonged::time) = time;
            e.parameter(prolonged::new_end) = 3.0;
            e.time_domain(0, 2);
            solve<Method>(tests::test_device(), e, with_tolerance(1e-10, 1.0 / 64));
            CHECK(e.t()[0] == 3.0);
            CHECK(std::abs(e.state(0)[0] - 2 * std::exp(-3.0)) < 1e-8);
        }
    });
}
TEST_CASE("tangents pass an action at a stop time like differences of trajectories") {
    using model = myriad::with_tangents<squared>;
    ensemble<model> e(1);
    myriad::initial_tangents(e);
    e.state(0) = 2.0;
    e.parameter(squared::time) = 1.0;
    e.time_domain(0, 2);
    solve<myriad::tsitouras_5>(tests::test_device(), e, with_tolerance(1e-10));
    // x(t) = x0 / (1 + x0 t); then squared: 4/9 at t = 1, where dx/dx0 = 1/9, times 2 x = 4/3
    const double at_stop = 4.0 / 9, growth = std::log(1.0 / 9 * 4.0 / 3 / std::pow(1 + at_stop, 2));
    CHECK(std::abs(e.state(0)[0] - at_stop / (1 + at_stop)) < 1e-8);
    CHECK(std::abs(e.accessory(model::growth())[0] - growth) < 1e-8);
}
TEST_CASE("instances with different stop times have the same bits alone and in any company") {
    each_method([]<class Method> {
        constexpr std::int64_t size = 37;
        auto e = treated(0, 0.5, 8, 5, size);
        for (std::int64_t i = 0; i < size; ++i) {
            e.parameter(dosed::first)[i] = 0.11 * static_cast<double>(i % 7);
            e.parameter(dosed::interval)[i] = 0.2 + 0.03 * static_cast<double>(i % 11);
        }
        options o = with_tolerance(1e-8);
        o.phase_length = 1.25;
        o.phases = 4;
        solve<Method>(tests::test_device(), e, o);
        for (std::int64_t i = 0; i < size; ++i) {
            auto single = treated(0, 0.5, 8, 5);
            auto scalar = treated<alone<dosed>>(0, 0.5, 8, 5);
            for (int c = 0; c < dosed::n_parameter; ++c) scalar.parameter(c) = single.parameter(c) = e.parameter(c)[i];
            solve<Method>(tests::test_device(), single, o);
            solve<Method>(tests::test_device(), scalar, o);
            CHECK(single.integer_accessory(dosed::given)[0] == e.integer_accessory(dosed::given)[i]);
            CHECK(scalar.integer_accessory(dosed::given)[0] == e.integer_accessory(dosed::given)[i]);
#if defined(MYRIAD_STRICT)
            CHECK(compare::difference(e, i, single, 0) == "");
            for (int c = 0; c < dosed::n_state; ++c) CHECK(compare::same_bits(scalar.state(c)[0], single.state(c)[0]));
            CHECK(scalar.accepted_steps()[0] == single.accepted_steps()[0]);
#endif
        }
    });
}
TEST_CASE("where no stop is met, stop times change no bit") {
    each_method([]<class Method> {
        auto e = treated(beyond, 1, 1, 5);
        e.state(dosed::gut) = 1.0;
        auto late = treated(5, 1, 1, 5);
        late.parameter(dosed::amount) = 0.0;
        late.state(dosed::gut) = 1.0;
        solve<Method>(tests::test_device(), e, with_tolerance(1e-9));
        solve<Method>(tests::test_device(), late, with_tolerance(1e-9));
        for (int c = 0; c < dosed::n_state; ++c) CHECK(compare::same_bits(e.state(c)[0], late.state(c)[0]));
        CHECK(e.rhs_evaluations()[0] == late.rhs_evaluations()[0]);
    });
}
TEST_CASE("an instance that its call's time limit interrupts has had all stops up to where it is") {
    auto e = treated(0, 0.25, 2'000'000'000, 4e8);
    options o = with_tolerance(1e-6);
    o.max_steps = 2'000'000'000;
    o.time_limit = 0.05;
    solve<myriad::tsitouras_5>(tests::test_device(), e, o);
    CHECK(e.status(0) == status::interrupted);
    CHECK(e.t()[0] > 0);
    CHECK(e.integer_accessory(dosed::given)[0] == static_cast<std::int32_t>(std::floor(e.t()[0] / 0.25)) + 1);
}
