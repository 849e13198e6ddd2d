// SPDX-License-Identifier: MIT
// Delays: against closed solutions, through events, stops, phases and calls, and what cannot be integrated.
#include "myriad/kernel/model/past.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/kernel/model/delay_models.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/device.hpp"

namespace {

using Catch::Matchers::Contains;
using delays::chain;
using delays::decay;
using delays::echo;
using delays::exponential;
using delays::logarithm;
using delays::pantograph;
using delays::recurrent;
using myriad::ensemble;
using myriad::options;
using myriad::solve;
using myriad::status;

/// The solution of `decay`, by the method of steps.
double decay_at(double t, double tau) {
    double sum = 0;
    for (int k = 0; (k - 1) * tau <= t; ++k) {
        double term = 1;
        for (int factor = 1; factor <= k; ++factor) term *= -(t - (k - 1) * tau) / factor;
        sum += term;
    }
    return sum;
}
/// Instances with delays of 0.5, 0.75, ...
template <class R = double>
ensemble<decay, R> decaying(std::int64_t size, double t_end) {
    ensemble<decay, R> e(size);
    for (std::int64_t i = 0; i < size; ++i)
        e.parameter(decay::tau)[i] = static_cast<R>(0.5 + 0.25 * static_cast<double>(i));
    e.state(decay::y) = R(1);
    e.integer_accessory(decay::steps) = 0;
    e.time_domain(0, static_cast<R>(t_end));
    return e;
}
options tolerance(double size) {
    options o;
    o.relative_tolerance = o.absolute_tolerance = size;
    return o;
}
options step(double h) {
    options o;
    o.step = h;
    return o;
}

/// The m of `exponential`, by Newton's method.
double growth(double tau, double a, double b) {
    double m = std::max(a + b, 0.0);
    for (int k = 0; k < 200; ++k) m -= (m - a * std::exp(-m * tau) - b) / (1 + a * tau * std::exp(-m * tau));
    return m;
}
ensemble<exponential> growing(const std::vector<double>& lags, double a, double b) {
    ensemble<exponential> e(static_cast<std::int64_t>(lags.size()));
    for (std::size_t i = 0; i < lags.size(); ++i) {
        const auto at = static_cast<std::int64_t>(i);
        e.parameter(exponential::tau)[at] = lags[i];
        e.parameter(exponential::m)[at] = growth(lags[i], a, b);
    }
    e.parameter(exponential::a) = a;
    e.parameter(exponential::b) = b;
    e.state(exponential::y) = 1;
    e.time_domain(0, 5);
    return e;
}

constexpr double infinite = std::numeric_limits<double>::infinity();
/// Instances that differ.
template <class Model>
ensemble<Model> varied();
template <>
ensemble<decay> varied() {
    return decaying(13, infinite);
}
template <>
ensemble<echo> varied() {
    ensemble<echo> e(13);
    for (int i = 0; i < 13; ++i) e.parameter(echo::tau)[i] = 0.3 + 0.11 * i;
    e.parameter(echo::period) = 1.3;
    e.state(echo::x) = 0;
    e.state(echo::z) = 0;
    e.accessory(echo::seen) = 0;
    e.accessory(echo::time) = 0;
    e.time_domain(0, infinite);
    return e;
}
template <>
ensemble<pantograph> varied() {
    ensemble<pantograph> e(13);
    for (int i = 0; i < 13; ++i) e.parameter(pantograph::q)[i] = 0.6 + 0.03 * i;
    e.state(pantograph::y) = 1;
    e.time_domain(0, infinite);
    return e;
}
template <>
ensemble<exponential> varied() {
    std::vector<double> lags;
    for (int i = 0; i < 13; ++i) lags.push_back(0.2 + 0.1 * i);
    auto e = growing(lags, 3, -50);
    e.time_domain(0, infinite);
    return e;
}
/// Phases of 0.25, with rings of 256 steps of at most 1/64, which are full from t = 4 on.
options in_short_rings(int phases) {
    options o = tolerance(1e-7);
    o.step = o.maximum_step = 1.0 / 64;
    o.history_steps = 256;
    o.phases = phases;
    o.phase_length = 0.25;
    return o;
}
template <class Model, class Method>
ensemble<Model> after(const std::vector<int>& calls, int threads = 1, bool reversed = false) {
    auto e = varied<Model>();
    if (reversed) {
        if constexpr (requires { Model::n_parameter; })
            for (int j = 0; j < Model::n_parameter; ++j)
                e.parameter(j) = Eigen::ArrayXd(e.parameter(j)).reverse().eval();
        for (int c = 0; c < Model::n_state; ++c) e.state(c) = Eigen::ArrayXd(e.state(c)).reverse().eval();
    }
    for (const int phases : calls) solve<Method>(tests::test_device(threads), e, in_short_rings(phases));
    for (int i = 0; i < e.size(); ++i) REQUIRE(e.status(i) == status::success);
    return e;
}
template <class Model>
void check_bits(const ensemble<Model>& found, const ensemble<Model>& wanted, bool reversed = false) {
    for (int c = 0; c < Model::n_state; ++c)
        for (int i = 0; i < wanted.size(); ++i)
            CHECK(found.state(c)[reversed ? wanted.size() - 1 - i : i] == wanted.state(c)[i]);
}

}  // namespace

TEST_CASE("a delayed equation follows the method of steps, with a delay for each instance") {
    auto e = decaying(9, 10);
    solve<myriad::dormand_prince_5>(tests::test_device(), e, tolerance(1e-9));
    for (int i = 0; i < e.size(); ++i) {
        INFO("instance " << i);
        CHECK(e.status(i) == status::success);
        CHECK(e.state(decay::y)[i] == Approx(decay_at(10, e.parameter(decay::tau)[i])).margin(5e-9));
    }
}
TEST_CASE("steps end where jumps of the past arrive: up to 4 tau a method of order 5 has no error") {
    auto e = decaying(9, 2);
    solve<myriad::dormand_prince_5>(tests::test_device(), e, tolerance(1e-3));
    for (int i = 0; i < e.size(); ++i) {
        INFO("instance " << i);
        CHECK(std::abs(e.state(decay::y)[i] - decay_at(2, e.parameter(decay::tau)[i])) < 1e-15);
    }
}
TEST_CASE("fixed steps with a delay keep their order") {
    double error[2];
    for (const int finer : {0, 1}) {
        auto e = decaying(9, 10);
        solve<myriad::runge_kutta_4>(tests::test_device(), e, step(finer == 0 ? 0.06 : 0.03));
        error[finer] = 0;
        for (int i = 0; i < e.size(); ++i)
            error[finer] += std::abs(e.state(decay::y)[i] - decay_at(10, e.parameter(decay::tau)[i]));
    }
    CHECK(error[0] < 1e-6);
    CHECK(error[0] / error[1] > 13);  // 16 for order 4
}
TEST_CASE("a delay in single precision") {
    auto e = decaying<float>(9, 10);
    solve<myriad::dormand_prince_5>(tests::test_device(), e, tolerance(1e-6));
    for (int i = 0; i < e.size(); ++i)
        CHECK(e.state(decay::y)[i] == Approx(decay_at(10, e.parameter(decay::tau)[i])).margin(2e-5));
}
TEST_CASE("two delays of two states") {
    const auto end = []<class Method>(double of) {
        ensemble<chain> e(1);
        for (int c = 0; c < chain::n_state; ++c) e.state(c) = 1;
        e.time_domain(0, 5);
        solve<Method>(tests::test_device(), e, tolerance(of));
        REQUIRE(e.status(0) == status::success);
        return std::vector<double>{e.state(chain::y1)[0], e.state(chain::y2)[0], e.state(chain::y3)[0]};
    };
    const auto tight = end.operator()<myriad::verner_7>(1e-13), loose = end.operator()<myriad::dormand_prince_5>(1e-8);
    double y1 = 0;  // the closed solution of the first, as of decay with the other sign
    for (int k = 0; k <= 6; ++k) y1 += std::pow(6.0 - k, k) / std::tgamma(k + 1.0);
    CHECK(tight[0] == Approx(y1).epsilon(1e-12));
    for (std::size_t c = 0; c < 3; ++c) CHECK(loose[c] == Approx(tight[c]).epsilon(1e-7));
}
TEST_CASE("a delay that depends on the state: jumps of the past are located") {
    ensemble<logarithm> e(9);
    e.state(logarithm::y) = 1;
    for (int i = 0; i < e.size(); ++i) {
        e.t_begin()[i] = 1;
        e.t_end()[i] = 2 + i;
    }
    solve<myriad::dormand_prince_5>(tests::test_device(), e, tolerance(1e-9));
    for (int i = 0; i < e.size(); ++i) {
        const double t = 2 + i, base = std::exp(1.0);
        const double y = t <= base          ? t
                         : t <= base * base ? std::exp(t / base)
                                            : std::pow(base / (3 - std::log(t)), base);
        INFO("t = " << t);
        CHECK(e.status(i) == status::success);
        CHECK(e.state(logarithm::y)[i] == Approx(y).epsilon(5e-9));
    }
}
TEST_CASE("the polynomial of a step that is much shorter than the way to a time beyond a jump says nothing of it") {
    namespace detail = myriad::detail;
    // y = t up to 1; a step of 1e-9, with errors of 1e-3 in it; a jump; and, again before a jump, another short step
    constexpr int slots = 8, terms = 6, fields = 1 + terms;
    const double shortest = 1e-9;
    double ring[slots * fields + 3] = {};
    const double starts[] = {0, 1, 1 + shortest, 1 + shortest, 1 + 2 * shortest, 1 + 2 * shortest};
    const double values[][terms] = {{0, 1}, {1, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3}, {1}, {5, 0, 0, 0, 0, 1e-3}, {5}};
    for (int k = 0; k < 6; ++k) {
        ring[k * fields] = starts[k];
        for (int power = 0; power < terms && k < 5; ++power) ring[k * fields + 1 + power] = values[k][power];
    }
    detail::past_view<logarithm, double> past = {};
    past.ring = ring;
    past.stride = 1;
    past.slots = slots;
    past.terms = terms;
    past.row = fields;
    past.reached = 2;
    past.lane[0].steps = 5;
    const auto seen_before = [&](int jump, double time) {
        past.lane[0].before[0] = jump;
        past.lane[0].forget();
        const auto& seen = past.look(0, 0, time, 3.0);
        return past.value_in(0, 0, seen, time);
    };
    CHECK(std::abs(seen_before(2, 1.5) - 1.5) < 1e-12);                // the step before the short one goes on
    CHECK(std::abs(seen_before(2, 1 + 2 * shortest) - 1.062) < 1e-6);  // near by, the short one does: 1 + 62e-3
    CHECK(std::abs(seen_before(4, 1.5) - (5 + 1e-3 * 32768)) < 1e-4);  // behind a jump it does to eight lengths
    CHECK(seen_before(5, 1.5) == 5);                                   // a step without length is what was set there
}

TEST_CASE("a delay may vanish, at the start or everywhere") {
    ensemble<pantograph> e(5);
    for (int i = 0; i < 5; ++i) e.parameter(pantograph::q)[i] = 0.2 + 0.2 * i;
    e.state(pantograph::y) = 1;
    e.time_domain(0, 5);
    solve<myriad::verner_7>(tests::test_device(), e, tolerance(1e-9));
    for (int i = 0; i < 5; ++i) {
        INFO("instance " << i);
        CHECK(e.status(i) == status::success);
        CHECK(e.state(pantograph::y)[i] == Approx(std::exp(-5.0)).epsilon(1e-7));
        CHECK(e.accepted_steps()[i] < 60);
    }
}
TEST_CASE("events see the past within their step, and the start of a phase what is there already") {
    using model = delays::watched_pantograph;
    ensemble<model> e(5);
    for (int i = 0; i < 5; ++i) e.parameter(pantograph::q)[i] = 0.2 + 0.2 * i;
    e.state(pantograph::y) = 1;
    e.time_domain(0, 5);
    solve<myriad::verner_7>(tests::test_device(), e, tolerance(1e-9));
    for (int i = 0; i < 5; ++i) {
        INFO("instance " << i);
        CHECK(e.status(i) == status::success);
        CHECK(e.accessory(model::at_begin)[i] == 1);
        CHECK(e.accessory(model::seen)[i] == Approx(std::log(2.0) / (0.2 + 0.2 * i)).epsilon(1e-7));
        CHECK(e.state(pantograph::y)[i] == Approx(std::exp(-5.0)).epsilon(1e-7));
        CHECK(e.accepted_steps()[i] < 60);
    }
}
TEST_CASE("a delay may be much shorter than the steps") {
    auto e = growing({1, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}, 1, 0);
    solve<myriad::dormand_prince_5>(tests::test_device(), e, tolerance(1e-9));
    for (int i = 0; i < e.size(); ++i) {
        INFO("tau = " << e.parameter(exponential::tau)[i]);
        CHECK(e.status(i) == status::success);
        CHECK(e.state(exponential::y)[i] == Approx(std::exp(5 * e.parameter(exponential::m)[i])).epsilon(1e-8));
        CHECK(e.accepted_steps()[i] < 120);
    }
}
TEST_CASE("a stiff equation with a delay") {
    auto e = growing({1, 0.5, 0.1}, 900, -1000);
    solve<myriad::rodas_5p>(tests::test_device(), e, tolerance(1e-8));
    for (int i = 0; i < e.size(); ++i) {
        INFO("tau = " << e.parameter(exponential::tau)[i]);
        CHECK(e.status(i) == status::success);
        CHECK(e.state(exponential::y)[i] == Approx(std::exp(5 * e.parameter(exponential::m)[i])).epsilon(1e-6));
        CHECK(e.accepted_steps()[i] < 400);
    }
}

TEST_CASE("what acts now is seen a delay later: events of the past, and jumps in it") {
    const auto check = []<class Method>(const options& o, double margin) {
        INFO(typeid(Method).name());
        ensemble<echo> e(3);
        e.state(echo::x) = 0;
        e.state(echo::z) = 0;
        for (int i = 0; i < 3; ++i) e.parameter(echo::tau)[i] = 0.3 + 0.25 * i;
        e.parameter(echo::period) = 1.5;
        e.accessory(echo::seen) = 0;
        e.accessory(echo::time) = 0;
        e.time_domain(0, 2.95);
        options with = o;
        with.events = {{.direction = myriad::direction::rising}};
        solve<Method>(tests::test_device(), e, with);
        for (int i = 0; i < 3; ++i) {
            const double tau = e.parameter(echo::tau)[i], since = 2.95 - tau;
            // the clock was 0 before 0, and back at 0 at 1.5
            const double z = since < 1.5 ? since * since / 2 : 1.5 * 1.5 / 2 + (since - 1.5) * (since - 1.5) / 2;
            INFO("tau = " << tau);
            CHECK(e.status(i) == status::success);
            CHECK(e.state(echo::x)[i] == Approx(1.45).margin(1e-13));
            CHECK(e.state(echo::z)[i] == Approx(z).margin(margin));
            CHECK(e.accessory(echo::time)[i] == Approx(1 + tau + (1 + 1.5 + tau <= 2.95 ? 1.5 : 0)).margin(1e-9));
            CHECK(e.accessory(echo::seen)[i] == Approx(1).margin(1e-9));
        }
    };
    check.operator()<myriad::dormand_prince_5>(tolerance(1e-4), 1e-13);
    check.operator()<myriad::runge_kutta_4>(step(0.04), 1e-13);
}

TEST_CASE("no trigger is lost where a jump of the past arrives as it acts, or between") {
    const auto check = []<class Method>(const options& o) {
        INFO(typeid(Method).name());
        ensemble<recurrent> e(6);
        const double lags[] = {0.02, 0.01, 0.005, 0.004, 0.0037, 0.03};
        for (int i = 0; i < 6; ++i) e.parameter(recurrent::tau)[i] = lags[i];
        e.state(recurrent::clock) = 0;
        e.integer_accessory(recurrent::count) = 0;
        e.time_domain(0, 2.005);
        solve<Method>(tests::test_device(), e, o);
        for (int i = 0; i < 6; ++i) {
            INFO("tau = " << lags[i]);
            CHECK(e.status(i) == status::success);
            CHECK(e.integer_accessory(recurrent::count)[i] == 200);
            CHECK(e.state(recurrent::clock)[i] == Approx(0.005).margin(1e-10));
        }
    };
    check.operator()<myriad::dormand_prince_5>(tolerance(1e-9));
    check.operator()<myriad::runge_kutta_4>(step(0.0015));
}

TEST_CASE("the past lasts from call to call and from phase to phase") {
    const auto at_once = [] {
        auto e = decaying(5, 6);
        solve<myriad::dormand_prince_5>(tests::test_device(), e, tolerance(1e-9));
        return e;
    }();
    SECTION("in phases that carry on") {
        auto e = decaying(5, 6);
        options o = tolerance(1e-9);
        o.phases = 12;
        o.phase_length = 0.5;
        solve<myriad::dormand_prince_5>(tests::test_device(), e, o);
        for (int i = 0; i < 5; ++i) CHECK(e.state(decay::y)[i] == Approx(at_once.state(decay::y)[i]).margin(5e-9));
    }
    SECTION("in calls") {
        auto e = decaying(5, 2.5);
        options o = tolerance(1e-9);
        o.phase_time = myriad::phase_time::carry_on;
        solve<myriad::dormand_prince_5>(tests::test_device(), e, o);
        e.time_domain(0, 6);
        solve<myriad::dormand_prince_5>(tests::test_device(), e, o);
        for (int i = 0; i < 5; ++i) CHECK(e.state(decay::y)[i] == Approx(at_once.state(decay::y)[i]).margin(5e-9));
    }
    SECTION("where time begins again in each phase") {
        auto e = decaying(5, 0.6);
        options o = tolerance(1e-9);
        o.phases = 10;
        solve<myriad::dormand_prince_5>(tests::test_device(), e, o);
        for (int i = 0; i < 5; ++i) CHECK(e.state(decay::y)[i] == Approx(at_once.state(decay::y)[i]).margin(5e-9));
    }
    SECTION("not after restart") {
        auto e = decaying(5, 6);
        solve<myriad::dormand_prince_5>(tests::test_device(), e, tolerance(1e-9));
        e.restart();
        e.state(decay::y) = 1;
        solve<myriad::dormand_prince_5>(tests::test_device(), e, tolerance(1e-9));
        for (int i = 0; i < 5; ++i) CHECK(e.state(decay::y)[i] == at_once.state(decay::y)[i]);
    }
    SECTION("with the same method only") {
        auto e = decaying(5, 1);
        solve<myriad::dormand_prince_5>(tests::test_device(), e, tolerance(1e-9));
        CHECK_THROWS_WITH(solve<myriad::runge_kutta_4>(tests::test_device(), e, step(0.01)), Contains("same method"));
    }
}
TEMPLATE_TEST_CASE("calls, neighbours, order and threads change no bit of instances whose rings are full", "",
                   (std::pair<decay, myriad::dormand_prince_5>), (std::pair<decay, myriad::runge_kutta_4>),
                   (std::pair<echo, myriad::dormand_prince_5>), (std::pair<echo, myriad::runge_kutta_4>),
                   (std::pair<pantograph, myriad::verner_7>), (std::pair<pantograph, myriad::cash_karp>),
                   (std::pair<exponential, myriad::rodas_5p>)) {
    using Model = typename TestType::first_type;
    using Method = typename TestType::second_type;
    const auto at_once = after<Model, Method>({24});
    check_bits(after<Model, Method>({1, 7, 16}), at_once);
    check_bits(after<Model, Method>(std::vector<int>(24, 1)), at_once);
    check_bits(after<Model, Method>({5, 19}, 2, true), at_once, true);
}
TEST_CASE("samples of a delayed equation") {
    auto e = decaying(3, 4);
    options o = tolerance(1e-9);
    o.samples.states = {decay::y};
    o.samples.evenly = o.samples.capacity = 41;
    solve<myriad::dense<myriad::tsitouras_5>>(tests::test_device(), e, o);
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k <= 40; ++k)
            CHECK(e.samples().state(decay::y)(i, k) ==
                  Approx(decay_at(0.1 * k, e.parameter(decay::tau)[i])).margin(2e-8));
}

TEST_CASE("delays that cannot be integrated have a status of their own") {
    SECTION("a past that is longer than what is kept of it") {
        auto e = decaying(2, 40);
        options o = step(0.01);
        o.history_steps = 60;  // 64
        solve<myriad::runge_kutta_4>(tests::test_device(), e, o);
        CHECK(e.status(0) == status::success);
        CHECK(e.status(1) == status::history_overflow);
        CHECK(e.t()[1] < 1.5);
    }
    SECTION("what was before the beginning is never lost") {
        auto e = decaying(1, 0.75);
        e.parameter(decay::tau)[0] = 2;
        options o = step(0.01);
        o.history_steps = 8;
        solve<myriad::runge_kutta_4>(tests::test_device(), e, o);
        CHECK(e.status(0) == status::success);
        CHECK(e.state(decay::y)[0] == Approx(decay_at(0.75, 2)));
        // A call that goes on looks beyond what is kept of it as well.
        e.time_domain(0.75, 1.5);
        solve<myriad::runge_kutta_4>(tests::test_device(), e, o);
        CHECK(e.status(0) == status::success);
        CHECK(e.state(decay::y)[0] == Approx(decay_at(1.5, 2)));
        e.time_domain(1.5, 3);
        solve<myriad::runge_kutta_4>(tests::test_device(), e, o);
        CHECK(e.status(0) == status::history_overflow);
        CHECK(e.t()[0] < 2.1);
    }
    SECTION("a step that the ring has lost is not seen, though it was seen last") {
        for (const std::int64_t kept : {1024, 128}) {
            ensemble<delays::frozen> e(1);
            e.state(delays::frozen::y) = 1;
            e.time_domain(0, 3);
            options o = tolerance(1e-9);
            o.maximum_step = 0.01;
            o.history_steps = kept;
            solve<myriad::dormand_prince_5>(tests::test_device(), e, o);
            CHECK(e.status(0) == (kept == 1024 ? status::success : status::history_overflow));
            // Up to its end the solution is the right one.
            CHECK(e.state(delays::frozen::y)[0] == Approx(57.0 / 32 + 1.25 * (e.t()[0] - 0.75)).margin(1e-8));
        }
    }
    SECTION("of which hardly anything is kept") {
        auto e = decaying(1, 4);
        options o = step(0.01);
        o.history_steps = 1;
        solve<myriad::runge_kutta_4>(tests::test_device(), e, o);
        CHECK(e.status(0) == status::history_overflow);
    }
    SECTION("negative, zero, not a number") {
        auto e = decaying(4, 4);
        e.parameter(decay::tau)[0] = -0.5;
        e.parameter(decay::tau)[1] = 0;
        solve<myriad::dormand_prince_5>(tests::test_device(), e, tolerance(1e-6));
        CHECK(e.status(0) == status::invalid_delay);
        CHECK(e.status(1) == status::invalid_delay);
        CHECK(e.status(2) == status::success);
        CHECK(e.t()[0] == 0);
        CHECK(e.state(decay::y)[0] == 1);
    }
    SECTION("shorter than a fixed step") {
        auto e = decaying(2, 4);
        solve<myriad::runge_kutta_4>(tests::test_device(), e, step(0.6));
        CHECK(e.status(0) == status::invalid_delay);
        CHECK(e.status(1) == status::success);
    }
    SECTION("backwards in time") {
        auto e = decaying(1, -4);
        solve<myriad::dormand_prince_5>(tests::test_device(), e, tolerance(1e-6));
        CHECK(e.status(0) == status::invalid_delay);
    }
}
TEST_CASE("a call that ends where the beginning arrives has not lost it") {
    for (const double tau : {2.0, 1.1, 0.7, 0.3}) {
        for (const double begin : {0.0, 0.1, -3.3, 1e-6}) {
            INFO("delay " << tau << " from " << begin);
            auto e = decaying(1, 1);
            e.parameter(decay::tau)[0] = tau;
            e.time_domain(begin, begin + tau);
            options o = step(0.01);
            o.history_steps = 8;
            solve<myriad::runge_kutta_4>(tests::test_device(), e, o);
            CHECK(e.status(0) == status::success);
            CHECK(e.state(decay::y)[0] == Approx(1 - tau).margin(1e-12));
        }
    }
}
TEST_CASE("a delay is as long as a fixed step up to rounding") {
    for (const double tau : {2.0, 1.1, 0.7, 0.3, 0.1}) {
        for (const double begin : {1e-6, 1e-9, -1.0, -2.1}) {
            INFO("delay " << tau << " from " << begin);
            auto e = decaying(1, 1);
            e.parameter(decay::tau)[0] = tau;
            e.time_domain(begin, begin + 10 * tau);
            solve<myriad::runge_kutta_4>(tests::test_device(), e, step(tau));
            CHECK(e.status(0) == status::success);
        }
    }
}
TEST_CASE("an infinite delay sees the beginning") {
    ensemble<delays::rare> e(1);
    e.parameter(delays::rare::r) = 0;
    e.state(delays::rare::y) = 1;
    e.time_domain(0, 2);
    solve<myriad::runge_kutta_4>(tests::test_device(), e, step(0.01));
    CHECK(e.status(0) == status::success);
    CHECK(e.state(delays::rare::y)[0] == Approx(3));
}
TEST_CASE("history_steps is an option of models with delays") {
    auto e = decaying(1, 1);
    options o = tolerance(1e-6);
    o.history_steps = -1;
    CHECK_THROWS_WITH(solve<myriad::dormand_prince_5>(tests::test_device(), e, o), Contains("history_steps"));
}
