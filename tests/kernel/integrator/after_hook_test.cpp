// SPDX-License-Identifier: MIT
// Consequences of values left by a hook or an earlier call: slopes, step sizes and failures.
#include <cmath>
#include <cstdint>
#include <limits>

#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/device.hpp"
#include "tests/support/hooked.hpp"
#include "tests/support/problems.hpp"

namespace {

using compare::each_method;
using compare::fixed_step;
using compare::with_tolerance;
using hooked::breaker;
using hooked::kicked_base;
using myriad::cash_karp;
using myriad::ensemble;
using myriad::options;
using myriad::solve;
using myriad::status;

/// Eight instances, kicked in their speed or their push at t = 1.
ensemble<hooked::kicked_scalar> kicked() {
    ensemble<hooked::kicked_scalar> e(8);
    e.state(kicked_base::x) = 1.0;
    e.state(kicked_base::v) = 0.0;
    e.accessory(kicked_base::push) = 0.0;
    for (std::int64_t i = 0; i < 8; ++i) {
        e.parameter(kicked_base::time)[i] = 1;
        e.parameter(kicked_base::size)[i] = 0.5 + 0.25 * static_cast<double>(i);
        e.parameter(kicked_base::in_push)[i] = static_cast<double>(i % 2);
    }
    e.time_domain(0, 2);
    return e;
}

template <class Method>
ensemble<breaker> broken(std::int32_t how) {
    ensemble<breaker> e(3);
    e.state(breaker::y0) = 0.0;
    e.integer_accessory(breaker::mode) = 0;
    e.integer_accessory(breaker::mode)[1] = how;
    e.integer_accessory(breaker::events_seen) = 0;
    e.time_domain(0, 4);
    options o = with_tolerance(1e-8, 0.25);
    o.phases = 2;
    o.max_steps = 5000;
    o.events = {{.tolerance = 1e-6, .stop_after = 1}};
    solve<Method>(tests::test_device(1), e, o);
    for (const std::int64_t neighbour : {0, 2}) {
        CHECK(e.status(neighbour) == status::success);  // nothing crosses in the second phase
        CHECK(e.phases_done()[neighbour] == 2);
        CHECK(e.integer_accessory(breaker::events_seen)[neighbour] == 1);
    }
    return e;
}

template <class Model>
ensemble<Model> books_of() {
    ensemble<Model> e(64);
    e.parameter(Model::w).setLinSpaced(0.5, 2);
    e.state(Model::x) = 0.2;
    e.state(Model::v) = 0.0;
    for (int c = 0; c < Model::n_accessory; ++c) e.accessory(c) = 0.0;
    e.time_domain(0, 20);
    options o = with_tolerance(1e-8);
    o.events = {{.direction = myriad::direction::falling, .tolerance = 1e-9}};
    solve<myriad::tsitouras_5>(tests::test_device(1), e, o);
    return e;
}

}  // namespace

TEST_CASE("books that only hooks read change no bit where the model declares them outputs, and cost no slope") {
    using hooked::bookkeeper;
    const auto plain = books_of<bookkeeper>();
    const auto declared = books_of<hooked::declared_bookkeeper>();
    for (const int c : {bookkeeper::x, bookkeeper::v}) CHECK((plain.state(c) == declared.state(c)).all());
    for (int c = 0; c < bookkeeper::n_accessory; ++c) CHECK((plain.accessory(c) == declared.accessory(c)).all());
    for (int c = 0; c < bookkeeper::n_integer_accessory; ++c)
        CHECK((plain.integer_accessory(c) == declared.integer_accessory(c)).all());
    CHECK((plain.accepted_steps() == declared.accepted_steps()).all());
    const Eigen::Array<std::int64_t, Eigen::Dynamic, 1> impacts =
        declared.integer_accessory(bookkeeper::impacts).cast<std::int64_t>();
    CHECK(impacts.minCoeff() > 0);
    // The last slope of a step remains the first of the next: one evaluation less per accepted step, except at impacts,
    // which change the state.
    const Eigen::Array<std::int64_t, Eigen::Dynamic, 1> saved = plain.rhs_evaluations() - declared.rhs_evaluations();
    CHECK((saved >= declared.accepted_steps() - 2 * impacts - 2).all());
}

TEST_CASE("samples do not hide a kick of after_step from the next step") {
    each_method([]<class Method> {
        options o = with_tolerance(1e-9, 1.0 / 64);
        o.maximum_step = 1.0 / 64;  // so that steps end at t = 1
        o.step = 1.0 / 64;
        auto plain = kicked(), sampled = kicked();
        solve<Method>(tests::test_device(1), plain, o);
        o.samples = {.states = {kicked_base::x}, .capacity = 400, .evenly = 400};
        solve<myriad::dense<Method>>(tests::test_device(1), sampled, o);
        CHECK((sampled.state(kicked_base::x) == plain.state(kicked_base::x)).all());
        CHECK((sampled.state(kicked_base::v) == plain.state(kicked_base::v)).all());
        CHECK((sampled.samples().stored() == 400).all());
        CHECK((plain.state(kicked_base::v) - std::sin(-2.0)).abs().minCoeff() > 0.01);  // kicked
    });
}

TEST_CASE("a failure stands though an event ends the phase in the same step") {
    for (const std::int32_t how : {breaker::state_not_finite, breaker::end_not_finite}) {
        CAPTURE(how);
        const auto fixed = broken<myriad::runge_kutta_4>(how);
        CHECK(fixed.status(1) == status::not_finite);
        CHECK(fixed.phases_done()[1] == 0);
        const auto adaptive = broken<cash_karp>(how);
        CHECK(adaptive.status(1) == status::not_finite);
        CHECK(adaptive.phases_done()[1] == 0);
    }
}

TEST_CASE("an adaptive method that carries on after fixed steps begins with the step of the options") {
    ensemble<problems::oscillator> e(4);
    e.state(0) = 1.0;
    e.state(1) = 0.0;
    e.time_domain(0, 1);
    options o = with_tolerance(1e-8, 1.0 / 64);
    o.phase_time = myriad::phase_time::restart;
    o.phase_step = myriad::phase_step::carry_on;
    solve<myriad::runge_kutta_4>(tests::test_device(1), e, o);
    solve<cash_karp>(tests::test_device(1), e, o);
    for (std::int64_t i = 0; i < 4; ++i) {
        CHECK(e.status(i) == status::success);
        CHECK(e.phases_done()[i] == 2);
    }
}

TEST_CASE("a step carried on from an earlier call keeps to the limits of this one") {
    ensemble<problems::oscillator> e(4);
    e.state(0) = 1.0;
    e.state(1) = 0.0;
    e.time_domain(0, 1);
    options o = with_tolerance(1e-3, 0.5);
    o.phase_step = myriad::phase_step::carry_on;
    solve<cash_karp>(tests::test_device(1), e, o);
    const auto before = e.accepted_steps()[0];
    CHECK(before < 10);
    o.maximum_step = 1.0 / 128;
    solve<cash_karp>(tests::test_device(1), e, o);
    CHECK(e.accepted_steps()[0] - before >= 128);
}

TEST_CASE("a step set by a hook keeps to the limits of the options") {
    ensemble<hooked::step_setter> e(1);
    e.state(0) = 0.0;
    e.parameter(hooked::step_setter::wanted) = 10.0;
    e.time_domain(0, 1);
    options o = with_tolerance(1e-3);
    o.step = o.maximum_step = 1.0 / 64;
    recorder::take();
    solve<cash_karp>(tests::test_device(1), e, o);
    for (const auto& step : recorder::take()) CHECK(step.h <= 1.0 / 64 * (1 + 1e-3));
    CHECK(e.accepted_steps()[0] == 64);
}

namespace {
/// Eleven instances; one of their hooks sets the step size of the odd ones to `wanted`.
template <class Model>
ensemble<Model> spoiled(int hook, double wanted) {
    ensemble<Model> e(11);
    e.state(0) = 0.0;
    e.parameter(Model::wanted) = wanted;
    for (std::int64_t i = 0; i < e.size(); ++i) e.integer_accessory(Model::which)[i] = i % 2 == 1 ? hook : Model::none;
    e.time_domain(0, 1);
    return e;
}
template <class Model>
void check_next_step_of_nan() {
    each_method([]<class Method> {
        const options o = fixed_step(0.125);
        auto healthy = spoiled<Model>(Model::none, 0);
        solve<Method>(tests::test_device(1), healthy, o);
        for (const int hook : {Model::in_initialise, Model::in_after_step, Model::in_after_event, Model::in_finalise}) {
            CAPTURE(hook);
            auto e = spoiled<Model>(hook, -1);  // the hook takes its root
            solve<Method>(tests::test_device(1), e, o);
            const double ends[] = {0, 0, 0.25, 0.5, 1};
            for (std::int64_t i = 0; i < e.size(); ++i) {
                CAPTURE(i);
                if (i % 2 == 0) {
                    CHECK(compare::difference(e, i, healthy, i) == "");
                } else {
                    CHECK(e.status(i) == status::not_finite);
                    CHECK(std::abs(e.t()[i] - ends[hook]) <= 1e-15);
                    CHECK(std::abs(e.state(0)[i] - ends[hook]) <= 1e-15);
                }
            }
        }
    });
}
}  // namespace

TEST_CASE("a next step of NaN ends the instance as not_finite, whichever hook set it") {
    check_next_step_of_nan<hooked::step_spoiler>();
    check_next_step_of_nan<hooked::step_spoiler_generic>();
}
TEST_CASE(
    "a next step longer than the domain is what is left of it, and one of zero is chosen anew where a phase begins, or "
    "ends the instance as step_underflow") {
    using model = hooked::step_spoiler;
    for (const int hook : {model::in_initialise, model::in_after_step, model::in_after_event}) {
        CAPTURE(hook);
        auto e = spoiled<model>(hook, 0);
        solve<cash_karp>(tests::test_device(1), e, with_tolerance(1e-6, 0.125));
        CHECK(e.status(1) == (hook == model::in_initialise ? status::success : status::step_underflow));
        CHECK(e.status(2) == status::success);
        e = spoiled<model>(hook, 1e300);
        solve<cash_karp>(tests::test_device(1), e, with_tolerance(1e-6, 0.125));
        CHECK(e.status(1) == status::success);
        CHECK(e.t()[1] == 1);
        CHECK(e.accepted_steps()[1] <= e.accepted_steps()[2]);
        if (hook == model::in_initialise) CHECK(e.accepted_steps()[1] == 2);  // one to the event, one to the end
    }
}
