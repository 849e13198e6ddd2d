// SPDX-License-Identifier: MIT
// Integration phases: many in one call or one by one, restarted and carried-over times and steps, records.
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/device.hpp"
#include "tests/support/faulty.hpp"
#include "tests/support/hooked.hpp"

namespace {

using compare::each_adaptive_method;
using compare::each_method;
using compare::fixed_step;
using compare::with_tolerance;
using hooked::phased;
using hooked::phased_by_events;
using hooked::stopper;
using myriad::cash_karp;
using myriad::device;
using myriad::ensemble;
using myriad::options;
using myriad::phase_step;
using myriad::phase_time;
using myriad::solve;
using myriad::status;

constexpr double pi = 3.14159265358979323846;

template <class Model, class R = double>
ensemble<Model, R> forced(R t_end) {
    constexpr std::int64_t size = 37;  // no multiple of any pack
    ensemble<Model, R> e(size);
    e.state(Model::x) = Eigen::Array<R, Eigen::Dynamic, 1>::LinSpaced(size, R(-0.5), R(1));
    e.state(Model::v) = R(0.25);
    e.parameter(Model::w) = Eigen::Array<R, Eigen::Dynamic, 1>::LinSpaced(size, R(0.5), R(2));
    e.shared(Model::B) = R(0.75);
    e.time_domain(0, t_end);
    return e;
}

/// `phases` of 6 in one call, against any other split of them into calls.
template <class Method, class Model, class R>
void check_splits(options o, R t_end) {
    constexpr std::int64_t phases = 6;
    auto whole = forced<Model, R>(t_end);
    o.phases = phases;
    solve<Method>(tests::test_device(1), whole, o);
    REQUIRE(whole.phases_done()[0] == phases);
    REQUIRE(whole.accepted_steps()[0] > phases);
    for (const auto& split : std::vector<std::vector<std::int64_t>>{{1, 1, 1, 1, 1, 1}, {2, 4}, {5, 1}}) {
        auto parts = forced<Model, R>(t_end);
        for (const std::int64_t part : split) {
            o.phases = part;
            solve<Method>(tests::test_device(1), parts, o);
        }
        CAPTURE(split);
        CHECK(compare::difference(whole, parts) == "");
    }
}

template <class R>
void check_all_splits(double tolerance) {
    each_method([&]<class Method> {
        for (const phase_step step : {phase_step::restart, phase_step::carry_on}) {
            options o = with_tolerance(tolerance, 1.0 / 32);
            o.phase_step = step;
            CAPTURE(static_cast<int>(step));
            check_splits<Method, phased, R>(o, R(2 * pi));
        }
    });
}

/// Every component of every recorded phase against an ensemble after that phase.
template <class Model, class R>
void check_row(const myriad::phase_records<Model, R>& records, std::int64_t row, const ensemble<Model, R>& e) {
    CAPTURE(row);
    for (int c = 0; c < myriad::detail::n_state<Model>; ++c)
        CHECK(compare::same_bits_everywhere(records.state(c).col(row), e.state(c)));
    for (int c = 0; c < myriad::detail::n_accessory<Model>; ++c)
        CHECK(compare::same_bits_everywhere(records.accessory(c).col(row), e.accessory(c)));
    for (int c = 0; c < myriad::detail::n_integer_accessory<Model>; ++c)
        CHECK(compare::same_bits_everywhere(records.integer_accessory(c).col(row), e.integer_accessory(c)));
    CHECK(compare::same_bits_everywhere(records.time().col(row), e.t()));
}

template <class Model>
void record_everything(options& o) {
    for (int c = 0; c < myriad::detail::n_state<Model>; ++c) o.record.states.push_back(c);
    for (int c = 0; c < myriad::detail::n_accessory<Model>; ++c) o.record.accessories.push_back(c);
    for (int c = 0; c < myriad::detail::n_integer_accessory<Model>; ++c) o.record.integer_accessories.push_back(c);
    o.record.time = true;
}

ensemble<stopper> stoppers(std::int64_t size, double t_end) {
    ensemble<stopper> e(size);
    e.state(0) = 0.0;
    e.parameter(stopper::phase_stop) = 1e9;
    e.parameter(stopper::instance_stop) = 1e9;
    e.time_domain(0, t_end);
    return e;
}

}  // namespace

// One call and many
// --------------------------------------------------------------------------------------------------------

TEST_CASE("phases in one call are phases in many calls, bit for bit") { check_all_splits<double>(1e-8); }
TEST_CASE("phases in one call are phases in many calls, bit for bit, in single precision") {
    check_all_splits<float>(1e-4);
}
TEST_CASE("phases ended by events, in one call, are phases in many calls, bit for bit") {
    each_method([]<class Method> {
        for (const phase_time time : {phase_time::restart, phase_time::carry_on}) {
            for (const phase_step step : {phase_step::restart, phase_step::carry_on}) {
                options o = with_tolerance(1e-8, 1.0 / 32);
                o.phase_time = time;
                o.phase_step = step;
                o.events.resize(2);
                o.events[phased_by_events::maximum].direction = myriad::direction::falling;
                o.events[phased_by_events::maximum].stop_after = 2;
                CAPTURE(static_cast<int>(time), static_cast<int>(step));
                check_splits<Method, phased_by_events, double>(o, 1e3);
            }
        }
    });
}
TEST_CASE("initialise sees the same times and steps in one call as in many") {
    using model = hooked::early_reader;
    each_method([]<class Method> {
        for (const phase_step step : {phase_step::restart, phase_step::carry_on}) {
            ensemble<model> whole(3), parts(3);
            for (auto* e : {&whole, &parts}) {
                e->state(0) = 1.0;
                e->state(1) = 0.0;
                e->time_domain(0, 3);
            }
            options o = with_tolerance(1e-8, 1.0 / 32);
            o.phase_step = step;
            for (int phase = 0; phase < 3; ++phase) solve<Method>(tests::test_device(1), parts, o);
            o.phases = 3;
            solve<Method>(tests::test_device(1), whole, o);
            CHECK(compare::difference(whole, parts) == "");
        }
    });
}

// Time and step at the start of a phase
// ------------------------------------------------------------------------------------

TEST_CASE("a phase starts at t_begin again") {
    // y' = t over [0, 1] adds 1/2 every time; exact for every method but for the roundings of about 6 steps of 6 stages
    each_method([]<class Method> {
        ensemble<hooked::ramp> e(5);
        e.state(0) = 0.0;
        e.time_domain(0, 1);
        options o = with_tolerance(1e-6, 0.125);
        o.phases = 7;
        solve<Method>(tests::test_device(1), e, o);
        CHECK((e.state(0) - 3.5).abs().maxCoeff() < 1e-13);
        CHECK((e.t() == 1).all());
    });
}
TEST_CASE("phases of a forcing's period continue one another") {
    each_method([]<class Method> {
        auto one = forced<phased>(2 * pi), many = forced<phased>(2 * pi);
        for (auto* e : {&one, &many})
            for (std::int64_t i = 0; i < e->size(); ++i) e->parameter(phased::w)[i] = static_cast<double>(i % 4);
        one.t_end() = 6 * pi;
        options o = with_tolerance(1e-10, pi / 256);
        solve<Method>(tests::test_device(1), one, o);
        o.phases = 3;
        solve<Method>(tests::test_device(1), many, o);
        // Some hundred steps with errors below 1e-10 |y|, |y| < 10 (RK4: (pi / 256)^5 / 120 = 2e-12), none of them
        // amplified by the oscillator; resonance at w = 1 adds them up.
        CHECK((one.state(0) - many.state(0)).abs().maxCoeff() < 1e-6);
        CHECK((one.state(1) - many.state(1)).abs().maxCoeff() < 1e-6);
    });
}
TEST_CASE("a phase may carry time on") {
    using model = hooked::early_reader;
    each_method([]<class Method> {
        // y' = 1 stops at t >= 1/2, after every step from then on, while time goes on
        auto e = stoppers(9, 100.0);
        e.parameter(stopper::phase_stop) = 0.5;
        options o = fixed_step(0.125);
        o.phase_time = phase_time::carry_on;
        solve<Method>(tests::test_device(1), e, o);
        CHECK((e.t() == 0.5).all());
        o.phases = 3;
        solve<Method>(tests::test_device(1), e, o);
        CHECK((e.t() == 0.875).all());
        CHECK((e.state(0) - 0.875).abs().maxCoeff() < 1e-15);

        ensemble<model> first(1);
        first.state(0) = 1.0;
        first.state(1) = 0.0;
        first.time_domain(2, 3);
        o.phases = 1;
        solve<Method>(tests::test_device(1), first, o);
        first.t_end() = 4;
        solve<Method>(tests::test_device(1), first, o);
        CHECK(first.accessory(model::t_seen)[0] == 3.0);
        CHECK(first.t()[0] == 4.0);
        CHECK(first.phases_done()[0] == 2);
        CHECK(first.status(0) == status::success);
    });
}
TEST_CASE("time that is carried on to a finite t_end leaves no phases without length in silence") {
    using Catch::Matchers::Contains;
    ensemble<hooked::ramp> e(5);
    e.state(0) = 0.0;
    e.time_domain(0, 10);
    options o = with_tolerance(1e-6, 0.125);
    o.phase_time = phase_time::carry_on;
    o.phases = 3;
    CHECK_THROWS_WITH(solve<cash_karp>(tests::test_device(1), e, o),
                      Contains("the call has 3 phases") && Contains("the first of them ends at t_end, 10") &&
                          Contains("phase_length"));
    CHECK(e.phases_done()[0] == 0);
    o.phases = 1;
    solve<cash_karp>(tests::test_device(1), e, o);
    CHECK_THROWS_WITH(solve<cash_karp>(tests::test_device(1), e, o),
                      Contains("t has reached t_end, 10 in instance 0") && Contains("later t_end"));
    e.t_end()[2] = 12;  // the others may be done
    solve<cash_karp>(tests::test_device(1), e, o);
    CHECK(e.t()[2] == 12);
    CHECK(e.t()[3] == 10);
    e.restart();
    CHECK_NOTHROW(solve<cash_karp>(tests::test_device(1), e, o));
    // Phases that something may end early are no mistake.
    auto stopped = stoppers(3, 1.0);
    stopped.parameter(stopper::phase_stop) = 0.5;
    o.phases = 9;
    CHECK(solve<cash_karp>(tests::test_device(1), stopped, o).notes.empty());
    const auto r = solve<cash_karp>(tests::test_device(1), stopped, o);
    REQUIRE(r.notes.size() == 1);
    CHECK_THAT(r.notes[0].text(), Contains("t had reached t_end in all instances"));
}

// Phases of a length
// --------------------------------------------------------------------------------------------------------

TEST_CASE("phases of a length go on in time, and their ends add up no rounding") {
    each_method([]<class Method> {
        for (const double sign : {1.0, -1.0}) {
            ensemble<hooked::ramp> e(5);
            e.state(0) = 0.0;
            e.time_domain(0, sign * std::numeric_limits<double>::infinity());
            e.t_begin().setLinSpaced(0, 4);
            options o = with_tolerance(1e-9, 0.0625);
            o.phase_length = 0.1;
            o.phases = 300;
            o.record = {.states = {0}, .time = true};
            for (int call = 0; call < 2; ++call) {
                const auto r = solve<Method>(tests::test_device(1), e, o);
                CHECK(r.count(status::success) == 5);
                for (int k = 1; k <= 300; ++k)
                    for (int i = 0; i < 5; ++i)
                        CHECK(r.records.time()(i, k - 1) == std::fma(sign * 0.1, 300 * call + k, i));
            }
            // y' = t; exact but for roundings of y up to 2000, two in each of a thousand steps
            for (int i = 0; i < 5; ++i)
                CHECK(std::abs(e.state(0)[i] - 0.5 * (e.t()[i] * e.t()[i] - i * i)) < 2000 * 2000 * 1.2e-16);
        }
    });
}
TEST_CASE("the last phase of a length ends at t_end, and none is without length") {
    using Catch::Matchers::Contains;
    ensemble<hooked::ramp> e(3);
    e.state(0) = 0.0;
    e.time_domain(0, 1);
    e.t_end() << 1, 0.95, 7;
    options o = with_tolerance(1e-9, 0.0625);
    o.phase_length = 0.1;
    o.phases = 11;
    CHECK_THROWS_WITH(solve<cash_karp>(tests::test_device(1), e, o),
                      Contains("the call has 11 phases") &&
                          Contains("instance 0 is at t = 0, from where 10 of phase_length 0.1 lead to its t_end, 1"));
    o.phases = 4;
    solve<cash_karp>(tests::test_device(1), e, o);
    CHECK_THROWS_WITH(solve<cash_karp>(tests::test_device(1), e,
                                       [&] {
                                           auto more = o;
                                           more.phases = 7;
                                           return more;
                                       }()),
                      Contains("the call has 7 phases") && Contains("from where 6 of phase_length 0.1"));
    o.phases = 6;
    solve<cash_karp>(tests::test_device(1), e, o);
    CHECK(e.t()[0] == 1);
    CHECK(e.t()[1] == 0.95);
    CHECK(e.t()[2] == 1);
    o.phases = 1;
    solve<cash_karp>(tests::test_device(1), e, o);  // the third goes on
    CHECK(e.t()[2] == 11 * 0.1);
    e.t_end() = 1;
    o.phases = 2;
    CHECK_THROWS_WITH(solve<cash_karp>(tests::test_device(1), e, o),
                      Contains("instance 1 is at t = 0.95, from where 1 of"));
}
TEST_CASE("a phase of a length that ends early leaves the rest to the next, and later ones end where they would have") {
    each_method([]<class Method> {
        auto e = stoppers(9, 100.0);
        e.parameter(stopper::phase_stop) = 0.5;
        e.parameter(stopper::phase_stop)[4] = 1e9;
        options o = fixed_step(0.125);
        o.phase_length = 1;
        const auto ends_at = [&](double others, double fourth) {
            solve<Method>(tests::test_device(1), e, o);
            CHECK(e.t()[4] == fourth);
            e.parameter(stopper::phase_stop)[4] = 0.0;
            CHECK((e.t().head(4) == others).all());
            CHECK((e.t().tail(4) == others).all());
            CHECK((e.state(0) - e.t()).abs().maxCoeff() < 1e-14);
            e.parameter(stopper::phase_stop)[4] = 1e9;
        };
        ends_at(0.5, 1);
        e.parameter(stopper::phase_stop) = 1e9;
        ends_at(1, 2);
        ends_at(2, 3);
    });
}
TEST_CASE("phases of a length in one call are phases in many calls, bit for bit") {
    each_method([]<class Method> {
        for (const phase_step step : {phase_step::restart, phase_step::carry_on}) {
            options o = with_tolerance(1e-8, 1.0 / 32);
            o.phase_step = step;
            o.phase_length = 1.7;
            check_splits<Method, phased, double>(o, 1e3);
            o.events.resize(2);
            o.events[phased_by_events::maximum].stop_after = 1;
            check_splits<Method, phased_by_events, double>(o, 1e3);
        }
    });
}
TEST_CASE("phases of a length in single precision end where rounding lets them") {
    auto e = forced<phased, float>(std::numeric_limits<float>::infinity());
    options o = with_tolerance(1e-4, 1.0 / 32);
    o.phase_length = 0.3;
    o.phases = 100;
    o.record.time = true;
    const auto r = solve<cash_karp>(tests::test_device(1), e, o);
    for (int k = 1; k <= 100; ++k)
        CHECK((r.records.time().col(k - 1) == std::fma(0.3f, static_cast<float>(k), 0.0f)).all());
}
TEST_CASE("a length of phases that cannot be is refused") {
    using Catch::Matchers::Contains;
    ensemble<hooked::ramp> e(3);
    e.state(0) = 0.0;
    e.time_domain(1e9, 2e9);
    const auto said = [&](double length, auto&& words) {
        options o = with_tolerance(1e-9);
        o.phase_length = length;
        CHECK_THROWS_WITH(solve<cash_karp>(tests::test_device(1), e, o), words);
    };
    said(-1, Contains("phase_length is -1 (must not be negative") && Contains("direction follows from t_end"));
    said(std::numeric_limits<double>::infinity(), Contains("phase_length is inf"));
    said(std::numeric_limits<double>::quiet_NaN(), Contains("phase_length is nan"));
    said(1e-6, Contains("phase_length is 1e-06, of which rounding leaves next to nothing") && Contains("shift t"));
    e.t_end() = 1e9;
    said(1, Contains("t has reached t_end, 1e+09"));

    ensemble<hooked::domain_writer> writer(2);
    options o = with_tolerance(1e-9);
    o.phase_length = 1;
    CHECK_THROWS_WITH(solve<cash_karp>(tests::test_device(1), writer, o), Contains("declares writes_time_domain"));
}
TEST_CASE("a phase starts with the first step of the options again") {
    using model = hooked::early_reader;
    each_adaptive_method([]<class Method> {
        ensemble<model> e(2);
        e.state(0) = 1.0;
        e.state(1) = 0.0;
        e.time_domain(0, 3);
        options o = with_tolerance(1e-8, 1.0 / 128);
        o.phases = 2;
        solve<Method>(tests::test_device(1), e, o);
        CHECK((e.accessory(model::h_next_seen) == 1.0 / 128).all());
    });
}
TEST_CASE("a phase may start with the step that the last one ended with") {
    using model = hooked::early_reader;
    each_adaptive_method([]<class Method> {
        ensemble<model> e(2);
        e.state(0) = 1.0;
        e.state(1) = 0.0;
        e.time_domain(0, 3);
        options o = with_tolerance(1e-8, 1.0 / 128);
        o.phase_step = phase_step::carry_on;
        solve<Method>(tests::test_device(1), e, o);
        CHECK((e.accessory(model::h_next_seen) == 1.0 / 128).all());
        const double carried = e.next_step()[0];
        REQUIRE(carried > 2.0 / 128);
        solve<Method>(tests::test_device(1), e, o);
        CHECK((e.accessory(model::h_next_seen) == carried).all());
    });
}
TEST_CASE("a step cut short by the end of the domain does not shorten the one carried over") {
    each_adaptive_method([]<class Method> {
        ensemble<hooked::early_reader> e(1);
        e.state(0) = 1.0;
        e.state(1) = 0.0;
        e.time_domain(0, 3);
        options o = with_tolerance(1e-6, 0.2);
        o.growth_limit = 1;  // so that growth does not hide it
        o.phase_step = phase_step::carry_on;
        e.t_end() = 0.21;  // one step of 0.2, one of 0.01
        solve<Method>(tests::test_device(1), e, o);
        REQUIRE(e.accepted_steps()[0] == 2);
        CHECK(e.next_step()[0] > 0.9 * 0.2);
    });
}
TEST_CASE("hooks see phases counted from the ensemble's start, over all calls") {
    using model = hooked::early_reader;
    each_method([]<class Method> {
        ensemble<model> e(20);
        e.state(0) = 1.0;
        e.state(1) = 0.0;
        e.time_domain(0, 0.5);
        options o = with_tolerance(1e-6, 0.25);
        solve<Method>(tests::test_device(1), e, o);
        CHECK((e.integer_accessory(model::phase_seen) == 0).all());
        for (std::int64_t i = 0; i < e.size(); ++i) CHECK(e.integer_accessory(model::index_seen)[i] == i);
        o.phases = 3;
        solve<Method>(tests::test_device(1), e, o);
        CHECK((e.integer_accessory(model::phase_seen) == 3).all());
        CHECK((e.phases_done() == 4).all());
        e.restart();
        solve<Method>(tests::test_device(1), e, o);
        CHECK((e.integer_accessory(model::phase_seen) == 2).all());
    });
}
TEST_CASE("a phase goes on from the state that finalise and initialise leave") {
    using model = hooked::renormalised;
    each_method([]<class Method> {
        ensemble<model> e(11);
        e.state(0) = 1.0;
        e.time_domain(0, 2);
        options o = with_tolerance(1e-9);
        o.phases = 10;
        const auto r = solve<Method>(tests::test_device(1), e, o);
        CHECK((e.accessory(model::started_at) == 2).all());
        CHECK((e.state(0) == 1).all());
        // growth rate one: every step adds a relative error below 1e-9 (RK4: (1/64)^5 / 120 = 1e-11)
        CHECK((e.accessory(model::sum) - 20).abs().maxCoeff() < 1e-9 * static_cast<double>(r.accepted_steps) / 11);
    });
}
TEST_CASE("the work of phases adds up") {
    each_method([]<class Method> {
        auto e = forced<phased>(2 * pi);
        options o = with_tolerance(1e-8);
        const auto first = solve<Method>(tests::test_device(1), e, o);
        o.phases = 2;
        const auto more = solve<Method>(tests::test_device(1), e, o);
        CHECK(first.accepted_steps > 0);
        CHECK(more.accepted_steps > first.accepted_steps);
        CHECK(first.accepted_steps + more.accepted_steps == e.accepted_steps().sum());
        CHECK(first.rejected_steps + more.rejected_steps == e.rejected_steps().sum());
        CHECK(first.rhs_evaluations + more.rhs_evaluations == e.rhs_evaluations().sum());
    });
}

TEST_CASE("an instance that a hook ended and that is given a new state is not left out in silence") {
    auto e = stoppers(9, 100.0);
    e.parameter(stopper::instance_stop) = 0.5;
    const options o = fixed_step(0.125);
    solve<myriad::runge_kutta_4>(tests::test_device(1), e, o);
    REQUIRE((e.t() == 0.5).all());
    solve<myriad::runge_kutta_4>(tests::test_device(1), e, o);  // they take no part, and none was requested
    e.state(0)[3] = 0.0;
    CHECK_THROWS_WITH(solve<myriad::runge_kutta_4>(tests::test_device(1), e, o),
                      Catch::Matchers::Contains("instance 3 ended in an earlier call (stopped_by_user)"));
}

// Records
// ------------------------------------------------------------------------------------------------------------------

TEST_CASE("records hold what single-phase calls give, bit for bit") {
    each_method([]<class Method> {
        options o = with_tolerance(1e-8, 1.0 / 32);
        auto parts = forced<phased>(2 * pi);
        auto whole = forced<phased>(2 * pi);
        options all = o;
        all.phases = 5;
        record_everything<phased>(all);
        const auto r = solve<Method>(tests::test_device(1), whole, all);
        REQUIRE(r.records.phases() == 5);
        for (std::int64_t row = 0; row < 5; ++row) {
            solve<Method>(tests::test_device(1), parts, o);
            check_row(r.records, row, parts);
        }
    });
}
TEST_CASE("records of phases that events end hold what single-phase calls give") {
    options o = with_tolerance(1e-8);
    o.phase_time = phase_time::carry_on;
    o.events.resize(2);
    o.events[phased_by_events::maximum].direction = myriad::direction::falling;
    o.events[phased_by_events::maximum].stop_after = 1;
    auto parts = forced<phased_by_events>(1e3);
    auto whole = forced<phased_by_events>(1e3);
    options all = o;
    all.phases = 4;
    record_everything<phased_by_events>(all);
    const auto r = solve<cash_karp>(tests::test_device(2), whole, all);
    CHECK(r.count(status::stopped_by_event) == whole.size());
    for (std::int64_t row = 0; row < 4; ++row) {
        solve<cash_karp>(tests::test_device(1), parts, o);
        check_row(r.records, row, parts);
    }
    // time went on, at different paces
    CHECK((r.records.time().col(3) > r.records.time().col(0)).all());
}
TEST_CASE("records begin with the phase asked for, counted in each call") {
    options o = with_tolerance(1e-8);
    auto parts = forced<phased>(2 * pi), whole = forced<phased>(2 * pi);
    for (int call = 0; call < 2; ++call) {
        options some = o;
        some.phases = 5;
        some.record.from_phase = 3;
        record_everything<phased>(some);
        const auto r = solve<cash_karp>(tests::test_device(1), whole, some);
        REQUIRE(r.records.phases() == 2);
        for (int phase = 0; phase < 5; ++phase) {
            solve<cash_karp>(tests::test_device(1), parts, o);
            if (phase >= 3) check_row(r.records, phase - 3, parts);
        }
    }
}
TEST_CASE("records hold the components asked for, in any order") {
    options o = with_tolerance(1e-8);
    o.phases = 2;
    o.record.states = {phased::v};
    o.record.accessories = {phased::sum_of_max, phased::x_start};
    o.record.integer_accessories = {phased::phases_begun};
    auto e = forced<phased>(2 * pi);
    const auto r = solve<cash_karp>(tests::test_device(1), e, o);
    CHECK(compare::same_bits_everywhere(r.records.state(phased::v).col(1), e.state(phased::v)));
    CHECK(compare::same_bits_everywhere(r.records.accessory(phased::x_start).col(1), e.accessory(phased::x_start)));
    CHECK(
        compare::same_bits_everywhere(r.records.accessory(phased::sum_of_max).col(1), e.accessory(phased::sum_of_max)));
    CHECK((r.records.integer_accessory(phased::phases_begun).col(0) == 1).all());
    CHECK((r.records.integer_accessory(phased::phases_begun).col(1) == 2).all());
    CHECK_THROWS_AS(r.records.state(phased::x), myriad::error);
    CHECK_THROWS_AS(r.records.accessory(phased::x_max), myriad::error);
    CHECK_THROWS_AS(r.records.integer_accessory(phased::steps), myriad::error);
    CHECK_THROWS_AS(r.records.time(), myriad::error);
}
TEST_CASE("nothing is recorded unless asked for") {
    auto e = forced<phased>(1.0);
    const auto r = solve<cash_karp>(tests::test_device(1), e, with_tolerance(1e-8));
    CHECK(r.records.phases() == 0);
    CHECK_THROWS_AS(r.records.state(phased::x), myriad::error);
}
TEST_CASE("an instance that ended itself has NaN and zero in the records of later phases") {
    each_method([]<class Method> {
        auto e = stoppers(20, 1.0);
        for (std::int64_t i = 0; i < e.size(); i += 3)
            e.parameter(stopper::instance_stop)[i] = 1.95;  // at the end of phase 1 (from 0)
        options o = fixed_step(0.125);
        o.phases = 4;
        record_everything<stopper>(o);
        const auto r = solve<Method>(tests::test_device(1), e, o);
        for (std::int64_t i = 0; i < e.size(); ++i) {
            for (std::int64_t row = 0; row < 4; ++row) {
                CAPTURE(i, row);
                const bool there = i % 3 != 0 || row <= 1;
                CHECK(std::isnan(r.records.state(0)(i, row)) == !there);
                CHECK(std::isnan(r.records.time()(i, row)) == !there);
                CHECK(r.records.integer_accessory(stopper::finished)(i, row) == (there ? row + 1 : 0));
            }
        }
    });
}
TEST_CASE("the phase in which an instance fails is not recorded") {
    each_method([]<class Method> {
        // y' = 1 until the square root's domain ends at 2.5: the third phase of [0, 1]
        ensemble<faulty::domain_fault> e(12);
        e.state(0) = 0.0;
        for (std::int64_t i = 0; i < e.size(); ++i) e.parameter(0)[i] = i % 2 == 0 ? 2.5 : 1e9;
        e.time_domain(0, 1);
        options o = fixed_step(0.125);
        o.phases = 4;
        o.record.states = {0};
        o.record.time = true;
        const auto r = solve<Method>(tests::test_device(1), e, o);
        CHECK(r.count(status::not_finite) == 6);
        for (std::int64_t i = 0; i < e.size(); ++i) {
            CHECK(e.phases_done()[i] == (i % 2 == 0 ? 2 : 4));
            for (std::int64_t row = 0; row < 4; ++row) {
                CAPTURE(i, row);
                CHECK(std::isnan(r.records.state(0)(i, row)) == (i % 2 == 0 && row >= 2));
                CHECK(std::isnan(r.records.time()(i, row)) == (i % 2 == 0 && row >= 2));
            }
        }
    });
}
TEST_CASE("phases over empty domains are recorded too") {
    auto e = stoppers(4, 0.0);
    options o = fixed_step(0.125);
    o.phases = 3;
    record_everything<stopper>(o);
    const auto r = solve<cash_karp>(tests::test_device(1), e, o);
    for (std::int64_t row = 0; row < 3; ++row) {
        CHECK((r.records.state(0).col(row) == 0).all());
        CHECK((r.records.time().col(row) == 0).all());
        CHECK((r.records.integer_accessory(stopper::finished).col(row) == static_cast<int>(row) + 1).all());
    }
}

// Ends by hooks
// ------------------------------------------------------------------------------------------------------------

TEST_CASE("end_phase ends the phase and not the instance") {
    each_method([]<class Method> {
        auto e = stoppers(10, 1.0);
        for (std::int64_t i = 0; i < e.size(); i += 2) e.parameter(stopper::phase_stop)[i] = 0.5;
        options o = fixed_step(0.125);
        o.phases = 3;
        const auto r = solve<Method>(tests::test_device(1), e, o);
        CHECK(r.count(status::stopped_by_user) == 5);
        CHECK(r.count(status::success) == 5);
        CHECK(r.failed() == 0);
        for (std::int64_t i = 0; i < e.size(); ++i) {
            CHECK(e.phases_done()[i] == 3);
            CHECK(e.t()[i] == (i % 2 == 0 ? 0.5 : 1.0));
            CHECK(std::abs(e.state(0)[i] - (i % 2 == 0 ? 1.5 : 3.0)) < 1e-14);
            CHECK(e.integer_accessory(stopper::begun)[i] == 3);
            CHECK(e.integer_accessory(stopper::finished)[i] == 3);
        }
    });
}
TEST_CASE("end_instance ends the instance, with finalise, and later calls leave it alone") {
    each_method([]<class Method> {
        auto e = stoppers(10, 1.0);
        for (std::int64_t i = 0; i < e.size(); i += 2) e.parameter(stopper::instance_stop)[i] = 1.2;
        options o = fixed_step(0.125);
        o.phases = 3;
        for (int call = 0; call < 2; ++call) {
            const auto r = solve<Method>(tests::test_device(1), e, o);
            CHECK(r.count(status::stopped_by_user) == 5);
            for (std::int64_t i = 0; i < e.size(); i += 2) {
                CHECK(e.phases_done()[i] == 2);
                CHECK(e.t()[i] == 0.25);
                CHECK(std::abs(e.state(0)[i] - 1.25) < 1e-14);
                CHECK(e.integer_accessory(stopper::begun)[i] == 2);
                CHECK(e.integer_accessory(stopper::finished)[i] == 2);
                CHECK(e.accepted_steps()[i] == 10);
            }
        }
        CHECK(e.phases_done()[1] == 6);
    });
}
TEST_CASE("a hook that ends the phase at t_end counts as the one who ended it") {
    each_method([]<class Method> {
        auto e = stoppers(1, 1.0);
        e.parameter(stopper::phase_stop) = 1.0;
        solve<Method>(tests::test_device(1), e, fixed_step(0.125));
        CHECK(e.status(0) == status::stopped_by_user);
        CHECK(e.t()[0] == 1.0);
    });
}
