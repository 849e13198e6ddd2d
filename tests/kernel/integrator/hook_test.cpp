// SPDX-License-Identifier: MIT
// Hooks: the order of their calls, what they see, what they may write, and the consequences; and the inputs of a
// right-hand side.
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/device.hpp"
#include "tests/support/hooked.hpp"

namespace {

using compare::each_method;
using compare::fixed_step;
using compare::with_tolerance;
using hooked::domain_writer;
using hooked::hooks_logged;
using hooked::kicked_base;
using hooked::parameter_writer;
using myriad::cash_karp;
using myriad::device;
using myriad::ensemble;
using myriad::options;
using myriad::solve;
using myriad::status;
using recorder::call;
using recorder::hook;

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = 3.14159265358979323846;

/// Every hook call of the oscillator from (1, 0) over [0, 5] in two phases, instance by instance.
template <class Method>
std::vector<std::vector<call>> calls_of(std::int64_t size) {
    ensemble<hooks_logged> e(size);
    for (std::int64_t i = 0; i < size; ++i) e.state(hooks_logged::x)[i] = 1 + 0.125 * static_cast<double>(i);
    e.state(hooks_logged::v) = 0.0;
    e.time_domain(0, 5);
    options o = with_tolerance(1e-9, 1.0 / 32);
    o.phases = 2;
    o.events.resize(3);
    for (auto& event : o.events) event.tolerance = 1e-9;
    recorder::take();
    solve<Method>(tests::test_device(1), e, o);
    std::vector<std::vector<call>> calls(static_cast<std::size_t>(size));
    for (const call& c : recorder::take()) calls.at(static_cast<std::size_t>(c.index)).push_back(c);
    for (std::size_t i = 0; i < calls.size(); ++i) {
        // as many steps logged as counted: rejected and redone trials call no hook
        std::int64_t steps = 0;
        for (const call& c : calls[i]) steps += c.which == hook::after_step;
        CHECK(steps == e.accepted_steps()[static_cast<std::int64_t>(i)]);
    }
    return calls;
}

template <class Model>
ensemble<Model> one(double state, double t_end, int mode) {
    ensemble<Model> e(1);
    e.state(0) = state;
    e.integer_accessory(0) = mode;
    e.time_domain(0, t_end);
    return e;
}

}  // namespace

// Order and view
// ----------------------------------------------------------------------------------------------------------

TEST_CASE("a phase is initialise, steps each followed by the events located at its end, and finalise") {
    each_method([]<class Method> {
        for (const auto& calls : calls_of<Method>(5)) {
            int phase = 0, events = 0;
            REQUIRE(calls.size() > 4);
            CHECK(calls.front().which == hook::initialise);
            CHECK(calls.back().which == hook::finalise);
            for (std::size_t i = 1; i < calls.size(); ++i) {
                const call& c = calls[i];
                const hook before = calls[i - 1].which;
                CAPTURE(i, c.t);
                CHECK(c.phase == (c.which == hook::initialise ? phase + 1 : phase));
                switch (c.which) {
                    case hook::initialise:
                        CHECK(before == hook::finalise);
                        ++phase;
                        break;
                    case hook::after_step:
                        CHECK(before != hook::finalise);
                        break;
                    case hook::after_event:
                        // right after the step that ends there, or after an event of lower index at the same time
                        CHECK((before == hook::after_step ||
                               (before == hook::after_event && calls[i - 1].event < c.event)));
                        CHECK(c.t == calls[i - 1].t);
                        ++events;
                        break;
                    case hook::finalise:
                        CHECK((before == hook::after_step || before == hook::after_event));
                        CHECK(c.t == 5.0);
                        break;
                }
            }
            CHECK(phase == 1);
            // [0, 5] holds a turning point at pi and zeros, of two event functions, at pi/2 and 3 pi/2. The second
            // phase starts elsewhere on the circle, and has as many of each, or one more or less.
            CHECK(events >= 5);
        }
    });
}
TEST_CASE("initialise sees the start of its phase") {
    each_method([]<class Method> {
        const auto calls = calls_of<Method>(3);
        for (std::size_t i = 0; i < calls.size(); ++i) {
            const call& first = calls[i].front();
            CHECK(first.t == 0.0);
            CHECK(first.t_begin == 0.0);
            CHECK(first.t_end == 5.0);
            CHECK(first.first == 1 + 0.125 * static_cast<double>(i));
            CHECK(first.last == 0.0);
            CHECK(first.phase == 0);
            for (std::size_t k = 1; k < calls[i].size(); ++k) {
                if (calls[i][k].which != hook::initialise) continue;
                CHECK(calls[i][k].t == 0.0);
                CHECK(calls[i][k].first == calls[i][k - 1].first);  // the state that finalise saw
                CHECK(calls[i][k].last == calls[i][k - 1].last);
            }
        }
    });
}
TEST_CASE("after_step sees the end of its step, its length and the state there") {
    each_method([]<class Method> {
        const auto calls = calls_of<Method>(3);
        for (std::size_t i = 0; i < calls.size(); ++i) {
            const double amplitude = 1 + 0.125 * static_cast<double>(i);
            double t = 0;
            for (const call& c : calls[i]) {
                if (c.phase > 0) break;
                if (c.which == hook::after_step) {
                    CAPTURE(c.t, c.h);
                    CHECK(c.h > 0);
                    CHECK(std::abs(c.t - (t + c.h)) <= 2 * eps * 5);  // sums of times below 5
                    // some hundred steps of errors below 1e-9 (RK4: (1/32)^5 / 120 = 2.5e-10) that do not grow
                    CHECK(std::abs(c.first - amplitude * std::cos(c.t)) < 1e-7);
                    CHECK(std::abs(c.last + amplitude * std::sin(c.t)) < 1e-7);
                    t = c.t;
                }
            }
            CHECK(t == 5.0);
        }
    });
}
TEST_CASE("after_event sees the state at the event and how often it has happened in this phase") {
    each_method([]<class Method> {
        for (const auto& calls : calls_of<Method>(3)) {
            int count[3] = {0, 0, 0};
            for (const call& c : calls) {
                if (c.which == hook::initialise) count[0] = count[1] = count[2] = 0;
                if (c.which != hook::after_event) continue;
                CAPTURE(c.t, c.event);
                CHECK(std::abs(c.event == hooks_logged::turning_point ? c.last : c.first) <=
                      1e-9);  // the event's tolerance
                CHECK(c.event_count == ++count[c.event]);
                if (c.phase == 0) {
                    const double sixth = c.t / (pi / 2);
                    CHECK(std::abs(sixth - std::round(sixth)) < 1e-7);
                }
            }
            CHECK(count[hooks_logged::zero] == count[hooks_logged::zero_too]);
        }
    });
}
TEST_CASE("events at the same time are handled in the order of their index") {
    each_method([]<class Method> {
        int pairs = 0;
        for (const auto& calls : calls_of<Method>(2)) {
            for (std::size_t i = 0; i < calls.size(); ++i) {
                if (calls[i].which != hook::after_event || calls[i].event != hooks_logged::zero) continue;
                REQUIRE(i + 1 < calls.size());
                CHECK(calls[i + 1].which == hook::after_event);
                CHECK(calls[i + 1].event == hooks_logged::zero_too);
                CHECK(calls[i + 1].t == calls[i].t);
                ++pairs;
            }
        }
        CHECK(pairs >= 4);
    });
}
TEST_CASE("finalise sees the end of its phase") {
    each_method([]<class Method> {
        for (const auto& calls : calls_of<Method>(3)) {
            for (std::size_t k = 1; k < calls.size(); ++k) {
                if (calls[k].which != hook::finalise) continue;
                CHECK(calls[k].t == 5.0);
                CHECK(calls[k].first == calls[k - 1].first);
                CHECK(calls[k].last == calls[k - 1].last);
                CHECK(calls[k].h == calls[k - 1].h);
            }
        }
    });
}

// Scalar and generic hooks
// --------------------------------------------------------------------------------------------------

TEST_CASE("a scalar and a generic after_step that say the same do the same") {
    using base = hooked::running_base;
    each_method([]<class Method> {
        const auto prepare = [](auto& e) {
            e.state(base::x) = Eigen::ArrayXd::LinSpaced(e.size(), 0.5, 2.0);
            e.state(base::v) = 0.5;
            e.parameter(base::lowest) = Eigen::ArrayXd::LinSpaced(e.size(), -3.0, 0.0);  // some never get there
            e.accessory(base::integral) = 0.0;
            e.accessory(base::maximum) = -1e30;
            e.integer_accessory(base::steps) = 0;
            e.time_domain(0, 6);
        };
        ensemble<hooked::running_scalar> scalar(45);
        ensemble<hooked::running_generic> generic(45);
        prepare(scalar);
        prepare(generic);
        options o = with_tolerance(1e-8, 1.0 / 32);
        o.phases = 2;
        const auto r = solve<Method>(tests::test_device(1), scalar, o);
        solve<Method>(tests::test_device(1), generic, o);
        CHECK(r.count(status::stopped_by_user) > 5);
        CHECK(r.count(status::success) > 5);
        for (std::int64_t i = 0; i < scalar.size(); ++i) {
            CAPTURE(i);
            CHECK(scalar.status(i) == generic.status(i));
            CHECK(scalar.integer_accessory(base::steps)[i] == generic.integer_accessory(base::steps)[i]);
            // Two kernels: where the compiler may contract, the step sizes may differ by roundings.
#if defined(MYRIAD_STRICT)
            const double bound = 0;
#else
            const double bound = 1e-12;
#endif
            CHECK(std::abs(scalar.t()[i] - generic.t()[i]) <= bound);
            CHECK(std::abs(scalar.state(base::x)[i] - generic.state(base::x)[i]) <= bound);
            CHECK(std::abs(scalar.accessory(base::integral)[i] - generic.accessory(base::integral)[i]) <= bound);
            CHECK(std::abs(scalar.accessory(base::maximum)[i] - generic.accessory(base::maximum)[i]) <= bound);
        }
    });
}
TEST_CASE("a running sum and maximum over the steps are those of the trajectory") {
    using base = hooked::running_base;
    each_method([]<class Method> {
        ensemble<hooked::running_generic> e(3);
        e.state(base::x) = 0.0;
        e.state(base::v) = 1.0;  // x = sin t
        e.parameter(base::lowest) = -0.5;
        e.accessory(base::integral) = 0.0;
        e.accessory(base::maximum) = -1.0;
        e.integer_accessory(base::steps) = 0;
        e.time_domain(0, 6);
        options o = with_tolerance(1e-8, 1.0 / 64);
        o.maximum_step = 1.0 / 64;
        solve<Method>(tests::test_device(1), e, o);
        CHECK(e.status(0) == status::stopped_by_user);
        // ends with the first step beyond 7 pi / 6
        CHECK(e.t()[0] >= 7 * pi / 6 - 1e-9);
        CHECK(e.t()[0] <= 7 * pi / 6 + 1.001 / 64);
        CHECK(e.state(base::x)[0] < -0.5);
        // a sum of rectangles: error h/2 times the change of x, below 1
        CHECK(std::abs(e.accessory(base::integral)[0] - (1 - std::cos(e.t()[0]))) < 1.0 / 64);
        CHECK(std::abs(e.accessory(base::maximum)[0] - 1) < 1.0 / 64 / 64);
        CHECK(e.integer_accessory(base::steps)[0] == e.accepted_steps()[0]);
    });
}

// Writing parameters and time domains
// -----------------------------------------------------------------------------------------

TEST_CASE("a parameter written by finalise is stored and counts from the next phase on") {
    each_method([]<class Method> {
        auto e = one<parameter_writer>(0.0, 1.0, parameter_writer::in_finalise);
        e.parameter(parameter_writer::rate) = 3.0;
        e.parameter(parameter_writer::untouched) = 0.7;
        options o = fixed_step(0.25);
        o.phases = 3;
        solve<Method>(tests::test_device(1), e, o);
        CHECK(e.parameter(parameter_writer::rate)[0] == 24.0);
        CHECK(e.parameter(parameter_writer::untouched)[0] == 0.7);
        CHECK(std::abs(e.state(0)[0] - (3.0 + 6.0 + 12.0)) < 1e-13);  // twelve steps of y' = const
    });
}
TEST_CASE("a parameter written by initialise counts in its own phase") {
    each_method([]<class Method> {
        auto e = one<parameter_writer>(0.0, 1.0, parameter_writer::in_initialise);
        e.parameter(parameter_writer::rate) = 3.0;
        e.parameter(parameter_writer::untouched) = 0.7;
        options o = fixed_step(0.25);
        o.phases = 3;
        solve<Method>(tests::test_device(1), e, o);
        CHECK(e.parameter(parameter_writer::rate)[0] == 24.0);
        CHECK(std::abs(e.state(0)[0] - (6.0 + 12.0 + 24.0)) < 1e-13);
    });
}
TEST_CASE("a parameter written by after_step counts from the next step on") {
    each_method([]<class Method> {
        auto e = one<parameter_writer>(0.0, 1.0, parameter_writer::in_after_step);
        e.parameter(parameter_writer::rate) = 3.0;
        e.parameter(parameter_writer::untouched) = 0.7;
        solve<Method>(tests::test_device(1), e, fixed_step(0.25));
        CHECK(e.parameter(parameter_writer::rate)[0] == 48.0);
        CHECK(std::abs(e.state(0)[0] - 0.25 * (3.0 + 6.0 + 12.0 + 24.0)) < 1e-13);
    });
}
TEST_CASE("instances that write parameters do not write those of others") {
    each_method([]<class Method> {
        ensemble<parameter_writer> e(50);
        e.state(0) = 0.0;
        e.parameter(parameter_writer::rate) = Eigen::ArrayXd::LinSpaced(50, 0.1, 1.7);
        e.parameter(parameter_writer::untouched) = Eigen::ArrayXd::LinSpaced(50, -1.0, 1.0);
        e.time_domain(0, 1);
        for (std::int64_t i = 0; i < 50; ++i) e.integer_accessory(parameter_writer::mode)[i] = static_cast<int>(i % 4);
        const Eigen::ArrayXd rate = e.parameter(parameter_writer::rate),
                             untouched = e.parameter(parameter_writer::untouched);
        solve<Method>(tests::test_device(2), e, fixed_step(0.25));
        for (std::int64_t i = 0; i < 50; ++i) {
            const double factor[] = {1, 2, 16, 2};
            CHECK(e.parameter(parameter_writer::rate)[i] == factor[i % 4] * rate[i]);
        }
        CHECK(compare::same_bits_everywhere(e.parameter(parameter_writer::untouched), untouched));
    });
}
TEST_CASE("a model that does not declare it leaves its parameters and time domains as they were") {
    auto e = ensemble<hooked::stopper>(30);
    e.state(0) = 0.0;
    e.parameter(0) = Eigen::ArrayXd::LinSpaced(30, 0.3, 1.1);
    e.parameter(1) = Eigen::ArrayXd::LinSpaced(30, 2.1, 1.7);
    e.t_begin() = Eigen::ArrayXd::LinSpaced(30, 0.0, 0.9);
    e.t_end() = Eigen::ArrayXd::LinSpaced(30, 1.0, 0.8);
    const Eigen::ArrayXd p0 = e.parameter(0), p1 = e.parameter(1), t0 = e.t_begin(), t1 = e.t_end();
    options o = with_tolerance(1e-6);
    o.phases = 3;
    solve<cash_karp>(tests::test_device(1), e, o);
    CHECK(compare::same_bits_everywhere(e.parameter(0), p0));
    CHECK(compare::same_bits_everywhere(e.parameter(1), p1));
    CHECK(compare::same_bits_everywhere(e.t_begin(), t0));
    CHECK(compare::same_bits_everywhere(e.t_end(), t1));
}

TEST_CASE("a time domain written by finalise is that of the next phase") {
    each_method([]<class Method> {
        auto e = one<domain_writer>(0.0, 1.0, domain_writer::shift_in_finalise);
        options o = fixed_step(0.25);
        o.phases = 3;
        o.record.accessories = {domain_writer::t_at_end};
        const auto r = solve<Method>(tests::test_device(1), e, o);
        // [0, 1], [1, 3], [3, 7], and then [7, 15]
        CHECK(r.records.accessory(domain_writer::t_at_end)(0, 0) == 1.0);
        CHECK(r.records.accessory(domain_writer::t_at_end)(0, 1) == 3.0);
        CHECK(r.records.accessory(domain_writer::t_at_end)(0, 2) == 7.0);
        CHECK(e.t_begin()[0] == 7.0);
        CHECK(e.t_end()[0] == 15.0);
        CHECK(std::abs(e.state(0)[0] - 7) < 1e-13);
    });
}
TEST_CASE("a time domain written by initialise is that of its own phase") {
    each_method([]<class Method> {
        auto e = one<domain_writer>(0.0, 1.0, domain_writer::set_in_initialise);
        solve<Method>(tests::test_device(1), e, fixed_step(0.25));
        CHECK(e.t()[0] == 5.0);
        CHECK(e.t_begin()[0] == 2.0);
        CHECK(e.t_end()[0] == 5.0);
        CHECK(std::abs(e.state(0)[0] - 3) < 1e-13);
    });
}
TEST_CASE("a phase goes on to a later t_end written by after_step") {
    each_method([]<class Method> {
        auto e = one<domain_writer>(0.0, 1.0, domain_writer::extend);
        solve<Method>(tests::test_device(1), e, fixed_step(0.25));
        CHECK(e.status(0) == status::success);
        CHECK(e.t()[0] == 3.0);
        CHECK(e.accepted_steps()[0] == 12);
        CHECK(std::abs(e.state(0)[0] - 3) < 1e-14);
        CHECK(e.t_end()[0] == 3.0);
    });
}
TEST_CASE("a phase ends at an earlier t_end written by after_step") {
    each_method([]<class Method> {
        auto e = one<domain_writer>(0.0, 1.0, domain_writer::cut);
        solve<Method>(tests::test_device(1), e, fixed_step(0.125));
        CHECK(e.status(0) == status::success);
        CHECK(e.t()[0] == 0.25);
        CHECK(e.accepted_steps()[0] == 2);
        CHECK(std::abs(e.state(0)[0] - 0.25) < 1e-15);
    });
}
TEST_CASE("a phase goes back to a t_end that after_step wrote too late") {
    each_method([]<class Method> {
        auto e = one<domain_writer>(0.0, 1.0, domain_writer::cut);
        options o = fixed_step(0.375);
        o.max_steps = 100;
        o.minimum_step = 0;
        solve<Method>(tests::test_device(1), e, o);
        CHECK(e.status(0) == status::success);
        CHECK(e.t()[0] == 0.25);
        CHECK(e.accepted_steps()[0] == 2);
        CHECK(std::abs(e.state(0)[0] - 0.25) < 1e-15);  // y' = 1 run backwards
    });
}
TEST_CASE("a phase is over where after_step makes the present its t_end") {
    each_method([]<class Method> {
        auto e = one<domain_writer>(0.0, 1.0, domain_writer::stop_here);
        solve<Method>(tests::test_device(1), e, fixed_step(0.125));
        CHECK(e.status(0) == status::success);
        CHECK(e.t()[0] == 0.5);
        CHECK(e.accepted_steps()[0] == 4);
    });
}
TEST_CASE("a t_begin written by after_step takes effect from the next phase on") {
    each_method([]<class Method> {
        auto e = one<domain_writer>(0.0, 1.0, domain_writer::begin_later);
        options o = fixed_step(0.125);
        solve<Method>(tests::test_device(1), e, o);
        CHECK(e.t()[0] == 1.0);
        CHECK(std::abs(e.state(0)[0] - 1) < 1e-14);
        CHECK(e.t_begin()[0] == 0.5);
        solve<Method>(tests::test_device(1), e, o);
        CHECK(e.t()[0] == 1.0);
        CHECK(std::abs(e.state(0)[0] - 1.5) < 1e-14);
    });
}
TEST_CASE("a step written by after_step is the next to be tried") {
    ensemble<hooked::step_setter> e(1);
    e.state(0) = 0.0;
    e.parameter(0) = 0.375;
    e.time_domain(0, 3);
    recorder::take();
    solve<cash_karp>(tests::test_device(1), e, with_tolerance(1e-6, 0.125));
    const auto steps = recorder::take();
    REQUIRE(steps.size() == 9);  // 1/8, seven times 3/8, and what is left
    CHECK(steps[0].h == 0.125);
    for (std::size_t i = 1; i < 8; ++i) CHECK(steps[i].h == 0.375);
    CHECK(steps[8].h == 0.25);
}

// What a right-hand side reads
// ------------------------------------------------------------------------------------------------

namespace {
template <class R>
void check_reader() {
    using model = hooked::reader;
    each_method([]<class Method> {
        ensemble<model, R> e(40);
        e.state(0) = R(0);
        e.shared(model::b0) = R(0.5);
        e.shared(model::b1) = R(0.25);
        e.shared_integer(model::m0) = 3;
        e.shared_integer(model::m1) = -7;
        for (std::int64_t i = 0; i < 40; ++i) {
            e.parameter(model::a)[i] = static_cast<R>(i);
            e.accessory(model::c0)[i] = static_cast<R>(1000);
            e.accessory(model::c1)[i] = static_cast<R>(2000 + 100 * i);
            e.integer_accessory(model::k0)[i] = static_cast<int>(i % 7);
            e.integer_accessory(model::k1)[i] = static_cast<int>(i % 5);
        }
        e.time_domain(0, 2);
        solve<Method>(tests::test_device(1), e, fixed_step(0.25));
        for (std::int64_t i = 0; i < 40; ++i) {
            const double rate =
                static_cast<double>(i) + 0.75 + 30 - 7 + (i % 5 > i % 7 ? 2000 + 100 * static_cast<double>(i) : 1000);
            CAPTURE(i);
            // eight steps, each rounded a few times
            CHECK(std::abs(static_cast<double>(e.state(0)[i]) / (2 * rate) - 1) <
                  40 * static_cast<double>(std::numeric_limits<R>::epsilon()));
        }
    });
}
}  // namespace

TEST_CASE("a right-hand side reads shared numbers, accessories and integers, its own") { check_reader<double>(); }
TEST_CASE("a right-hand side reads shared numbers, accessories and integers, its own, in single precision") {
    check_reader<float>();
}

// Hooks that change what slopes depend on
// -------------------------------------------------------------------------------------

namespace {

/// A kick at t = 1 by a hook, against a stop there, the same kick by hand, and a start from there.
template <class Model, class Method>
void check_kick(double in_push) {
    ensemble<Model> hooked_kick(20), by_hand(20);
    for (auto* e : {&hooked_kick, &by_hand}) {
        e->state(kicked_base::x) = Eigen::ArrayXd::LinSpaced(20, -1.0, 1.0);
        e->state(kicked_base::v) = 0.5;
        e->accessory(kicked_base::push) = 0.0;
        e->parameter(kicked_base::size) = 0.75;
        e->parameter(kicked_base::in_push) = in_push;
    }
    const options o = fixed_step(0.125);
    hooked_kick.parameter(kicked_base::time) = 1.0;
    hooked_kick.time_domain(0, 3);
    solve<Method>(tests::test_device(1), hooked_kick, o);

    by_hand.parameter(kicked_base::time) = 1e9;
    by_hand.time_domain(0, 1);
    solve<Method>(tests::test_device(1), by_hand, o);
    if (in_push == 0.0) {
        by_hand.state(kicked_base::v) += 0.75;
    } else {
        by_hand.accessory(kicked_base::push) += 0.75;
    }
    by_hand.restart();
    by_hand.time_domain(1, 3);
    solve<Method>(tests::test_device(1), by_hand, o);
    CHECK(compare::same_bits_everywhere(hooked_kick.state(kicked_base::x), by_hand.state(kicked_base::x)));
    CHECK(compare::same_bits_everywhere(hooked_kick.state(kicked_base::v), by_hand.state(kicked_base::v)));
    // and the kick mattered
    CHECK((hooked_kick.state(kicked_base::v) - 0.75).abs().maxCoeff() > 0.1);
}

}  // namespace

TEST_CASE("a state changed by a scalar after_step is where the next step starts, as after a restart") {
    each_method([]<class Method> { check_kick<hooked::kicked_scalar, Method>(0); });
}
TEST_CASE("a state changed by a generic after_step is where the next step starts, as after a restart") {
    each_method([]<class Method> { check_kick<hooked::kicked_generic, Method>(0); });
}
TEST_CASE("an accessory changed by a scalar after_step reaches the next slope, as after a restart") {
    each_method([]<class Method> { check_kick<hooked::kicked_scalar, Method>(1); });
}
TEST_CASE("an accessory changed by a generic after_step reaches the next slope, as after a restart") {
    each_method([]<class Method> { check_kick<hooked::kicked_generic, Method>(1); });
}
