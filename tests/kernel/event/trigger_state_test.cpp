// SPDX-License-Identifier: MIT
// Triggers: actions where a condition of several event functions comes to hold.
#include "myriad/kernel/event/trigger_state.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/kernel/event/trigger_models.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/device.hpp"

namespace {

using compare::with_tolerance;
using myriad::ensemble;
using myriad::options;
using myriad::solve;
using myriad::status;
using triggers::alone;
using triggers::cascade;
using triggers::chain;
using triggers::edges;
using triggers::logic;
using triggers::relay;
using triggers::thermostat;

constexpr double half_pi = std::numbers::pi / 2;

/// Steps that contain one crossing of the cosine at most.
options short_steps() {
    options o = with_tolerance(1e-9, 0.1);
    o.maximum_step = 0.5;
    return o;
}
template <class Model, class Method>
ensemble<Model> run_logic(double c, const options& o = short_steps()) {
    ensemble<Model> e(1);
    e.state(0) = 0.0;
    e.parameter(logic::c) = c;
    e.time_domain(0, 8);
    solve<Method>(tests::test_device(), e, o);
    CHECK(e.status(0) == status::success);
    return e;
}
template <class Model, class Method>
void check_logic(double c, std::int32_t code, const std::vector<double>& times) {
    CAPTURE(c);
    const auto e = run_logic<Model, Method>(c);
    CHECK(e.integer_accessory(logic::code)[0] == code);
    REQUIRE(e.integer_accessory(logic::actions)[0] == static_cast<int>(times.size()));
    for (std::size_t k = 0; k < times.size(); ++k)
        CHECK(std::abs(e.accessory(static_cast<int>(k))[0] - times[k]) < 1e-12);
}

/// `test.operator()<Model, Method>()`, in packs and one by one.
template <class Test>
void each_logic(Test test) {
    test.template operator()<logic, myriad::runge_kutta_4>();
    test.template operator()<logic, myriad::tsitouras_5>();
    test.template operator()<alone<logic>, myriad::tsitouras_5>();
}

}  // namespace

TEST_CASE("actions run where conditions come to hold, at the crossing that makes them") {
    each_logic([]<class Model, class Method>() {
        // cos t is positive up to pi/2, from 3 pi/2 to 5 pi/2, and not at the end; `at_start` follows it, from 0 on
        check_logic<Model, Method>(1, 4114, {0, 1, 3 * half_pi, 3 * half_pi});
        // `either` holds at first, fails at pi/2, and comes to hold at 2
        check_logic<Model, Method>(2, 43214, {0, half_pi, 2, 3 * half_pi, 3 * half_pi});
        check_logic<Model, Method>(6, 43241, {0, half_pi, 3 * half_pi, 3 * half_pi, 6});
    });
}
TEST_CASE("where two functions cross at once, a condition that holds before and after does not fire") {
    each_logic([]<class Model, class Method>() {
        // At pi/2 cos t falls and t - c rises: `either` holds all the time, and `neither` never.
        const auto e = run_logic<Model, Method>(half_pi);
        const std::int32_t code = e.integer_accessory(logic::code)[0];
        CAPTURE(code);
        CHECK(code % 100 == 14);  // both at 3 pi/2
        for (std::int32_t left = code; left > 0; left /= 10) {
            CHECK(left % 10 != logic::either + 1);
            CHECK(left % 10 != logic::neither + 1);
        }
    });
}
TEST_CASE("conditions keep their truth from phase to phase") {
    each_logic([]<class Model, class Method>() {
        options o = short_steps();
        o.phase_length = 1;
        o.phases = 8;
        const auto e = run_logic<Model, Method>(2, o);
        CHECK(e.integer_accessory(logic::code)[0] == 43214);
        CHECK(e.phases_done()[0] == 8);
    });
}
TEST_CASE("an action brings others about at once, and conditions that fail meanwhile lapse unless they persist") {
    const auto check = []<class Model>() {
        ensemble<Model> e(2);
        for (int c = 0; c < chain::n_state; ++c) e.state(c) = 0.0;
        e.time_domain(0, 3);
        solve<myriad::tsitouras_5>(tests::test_device(), e, with_tolerance(1e-9));
        for (int i = 0; i < 2; ++i) {
            CHECK(e.status(i) == status::success);
            CHECK(e.integer_accessory(chain::code)[i] == 124);
            CHECK(std::abs(e.accessory(chain::time)[i] - 1) < 1e-12);
        }
        ensemble<Model> ended(1);
        for (int c = 0; c < chain::n_state; ++c) ended.state(c) = 0.0;
        ended.shared_integer(chain::end_at) = 12;
        ended.time_domain(0, 3);
        solve<myriad::tsitouras_5>(tests::test_device(), ended, with_tolerance(1e-9));
        CHECK(ended.status(0) == status::stopped_by_user);
        CHECK(ended.integer_accessory(chain::code)[0] == 124);
    };
    check.operator()<chain>();
    check.operator()<alone<chain>>();
}
TEST_CASE("a condition waits for the function that holds last") {
    // Falls from 1/2 with the heater off, which may only be switched on from `from` on.
    ensemble<thermostat> e(3);
    e.state(0) = 0.5;
    e.parameter(thermostat::from) << 0, 0.5, 2;
    e.time_domain(0, 3);
    solve<myriad::tsitouras_5>(tests::test_device(), e, with_tolerance(1e-10));
    // on at 1/2, off at 3/2, on at 5/2, up to 1/2; on at 2 at x = -3/2
    CHECK(std::abs(e.state(0)[0] - 0.5) < 1e-9);
    CHECK(std::abs(e.state(0)[2] + 0.5) < 1e-9);
    CHECK(e.integer_accessory(thermostat::switched)[0] == 3);
    CHECK(e.integer_accessory(thermostat::switched)[1] == 3);
    CHECK(e.integer_accessory(thermostat::switched)[2] == 1);
}
TEST_CASE("a trigger's action sets a stop time, also for the same instant, and the stop's action resets the trigger") {
    // from 0 it reaches 1 at 1, 3 and 5; from 3/2, above it at first, at once
    ensemble<relay> e(4);
    e.state(0) << 0, 0, 1.5, 1.5;
    e.parameter(relay::delay) << 0, 0.5, 0, 0.25;
    e.time_domain(0, 6);
    solve<myriad::tsitouras_5>(tests::test_device(), e, with_tolerance(1e-9));
    for (int i = 0; i < 4; ++i) CHECK(e.status(i) == status::success);
    for (const int i : {0, 1}) {
        CHECK(e.integer_accessory(relay::actions)[i] == 3);
        CHECK(std::abs(e.state(0)[i]) < 1e-9);
    }
    for (const int i : {2, 3}) {
        CHECK(e.integer_accessory(relay::actions)[i] == 4);  // at 0, 3/2, 7/2 and 11/2
        CHECK(std::abs(e.state(0)[i] + 0.5) < 1e-9);
    }
}

TEST_CASE("what an action brings about comes before the next that is due, if its priority is higher") {
    const auto check = []<class Model>() {
        ensemble<Model> e(3);
        for (int c = 0; c < cascade::n_state; ++c) e.state(c) = 0.0;
        e.time_domain(0, 3);
        solve<myriad::tsitouras_5>(tests::test_device(), e, with_tolerance(1e-9));
        for (int i = 0; i < 3; ++i) {
            CHECK(e.status(i) == status::success);
            CHECK(e.integer_accessory(cascade::code)[i] == 321);
        }
    };
    check.operator()<cascade>();
    check.operator()<alone<cascade>>();
}

TEST_CASE("a function on its surface counts as positive, and at the same instant as on the side to which it goes") {
    struct expected {
        double x, rate, c;  // c is after the end where no action sets x
        int reached;
        double t_reached;
        int passed;
        double t_passed;
    };
    const std::vector<expected> all = {
        {0, 1, 9, 1, 1, 1, 1},           // both at the crossing
        {1, 1, 9, 0, -1, 1, 0},          // x >= 1 has held all the time, x > 1 begins to right after the start
        {1, -1, 9, 0, -1, 0, -1},        // and here x >= 1 ceases to
        {1, 0, 9, 0, -1, 0, -1},         //
        {0, 1, 0.25, 1, 0.25, 1, 0.25},  // set to 1 by an action
        {0, -1, 0.25, 1, 0.25, 0, -1},   //
        {0, 0, 0.25, 1, 0.25, 0, -1},    //
        {3, -1, 0.25, 0, -1, 0, -1},     // from above, x >= 1 holds still, and then ceases to
        {3, 1, 0.25, 0, -1, 1, 0.25},    // x > 1 fails for the instant
    };
    const auto check = [&]<class Model>() {
        ensemble<Model> e(static_cast<std::int64_t>(all.size()));
        for (std::size_t k = 0; k < all.size(); ++k) {
            const auto i = static_cast<std::int64_t>(k);
            e.state(0)[i] = all[k].x;
            e.parameter(edges::rate)[i] = all[k].rate;
            e.parameter(edges::c)[i] = all[k].c;
        }
        for (int c = 0; c < edges::n_accessory; ++c) e.accessory(c) = -1.0;
        for (int c = 0; c < edges::n_integer_accessory; ++c) e.integer_accessory(c) = 0;
        e.time_domain(0, 2);
        solve<myriad::tsitouras_5>(tests::test_device(), e, with_tolerance(1e-9, 0.3));
        for (std::size_t k = 0; k < all.size(); ++k) {
            CAPTURE(k);
            const auto i = static_cast<std::int64_t>(k);
            CHECK(e.status(i) == status::success);
            CHECK(e.integer_accessory(edges::times_reached)[i] == all[k].reached);
            CHECK(e.integer_accessory(edges::times_passed)[i] == all[k].passed);
            CHECK(std::abs(e.accessory(edges::t_reached)[i] - all[k].t_reached) < 1e-12);
            CHECK(std::abs(e.accessory(edges::t_passed)[i] - all[k].t_passed) < 1e-12);
        }
    };
    check.operator()<edges>();
    check.operator()<alone<edges>>();
}

namespace {

template <class Model>
myriad::ensemble<Model> fallen(double step) {
    myriad::ensemble<Model> e(3);
    for (int c = 0; c < Model::n_state; ++c) e.state(c) = 0.0;
    for (int c = 0; c < Model::n_accessory; ++c) e.accessory(c) = -1.0;
    for (int c = 0; c < Model::n_integer_accessory; ++c) e.integer_accessory(c) = 0;
    e.time_domain(0, 2);
    myriad::options o;
    o.step = o.maximum_step = step;
    myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, o);
    return e;
}

}  // namespace

TEST_CASE("a trigger does not act while a step is redone to an event, and the event is found where it is") {
    using model = triggers::falling;
    for (const double step : {1.0, 0.3, 0.01}) {
        CAPTURE(step);
        const auto together = fallen<model>(step);
        const auto alone = fallen<triggers::alone<model>>(step);
        for (int i = 0; i < 3; ++i) {
            CHECK(together.integer_accessory(model::actions)[i] == 1);
            CHECK(together.integer_accessory(model::detections)[i] == alone.integer_accessory(model::detections)[i]);
            for (int c = 0; c < model::n_accessory; ++c) CHECK(together.accessory(c)[i] == alone.accessory(c)[i]);
            if (together.integer_accessory(model::detections)[i] > 0)
                CHECK(std::abs(together.accessory(model::y_event)[i] - 0.5) < 1e-12);
        }
    }
}
