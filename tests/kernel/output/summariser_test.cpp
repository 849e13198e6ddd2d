// SPDX-License-Identifier: MIT
// Extrema, their times and integrals along the solution, against closed forms.
#include <cmath>
#include <numbers>

#include "tests/catch.hpp"
#include "tests/kernel/output/summarised.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/device.hpp"

using namespace summarised;
using myriad::cash_karp;
using myriad::dense;
using myriad::dormand_prince_5;
using myriad::dormand_prince_8;
using myriad::ensemble;
using myriad::options;
using myriad::rodas_5p;
using myriad::rosenbrock_23;
using myriad::runge_kutta_4;
using myriad::solve;
using myriad::tsitouras_5;
using myriad::verner_7;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double from = 0.3;  // x = sin(t + from), so that no extremum is at an end of the domain

/// Eleven swings over domains of a length near `span`, some two and a half periods for 17; a negative span goes
/// backwards.
template <class Model, class R = double>
ensemble<Model, R> swings(double span = 17) {
    ensemble<Model, R> e(11);
    e.state(0) = static_cast<R>(std::sin(from));
    e.state(1) = static_cast<R>(std::cos(from));
    e.t_begin() = R(0);
    for (std::int64_t i = 0; i < e.size(); ++i)
        e.t_end()[i] = static_cast<R>(span * (1 + 0.01 * static_cast<double>(i)));
    return e;
}

/// Distance of a time from the nearest one at which t + from is `phase` modulo 2 pi.
double off_phase(double t, double phase) { return std::abs(std::remainder(t + from - phase, 2 * pi)); }
double integral_of_square(double t) { return t / 2 - (std::sin(2 * (t + from)) - std::sin(2 * from)) / 4; }

/// The largest errors over the ensemble: of the state at the end, of both extrema, of their times, of the integral.
struct errors {
    double state = 0, extremum = 0, time = 0, integral = 0;
};
template <class R>
errors errors_of(const ensemble<swing, R>& e) {
    errors worst;
    const auto add = [](double& to_worst, double error) {
        to_worst = error <= to_worst ? to_worst : error;
    };  // NaN wins
    for (std::int64_t i = 0; i < e.size(); ++i) {
        const double t = static_cast<double>(e.t_end()[i]);
        add(worst.state, std::hypot(static_cast<double>(e.state(swing::x)[i]) - std::sin(t + from),
                                    static_cast<double>(e.state(swing::v)[i]) - std::cos(t + from)));
        add(worst.extremum, std::abs(static_cast<double>(e.accessory(swing::x_max)[i]) - 1));
        add(worst.extremum, std::abs(static_cast<double>(e.accessory(swing::x_min)[i]) + 1));
        add(worst.time, off_phase(static_cast<double>(e.accessory(swing::t_max)[i]), pi / 2));
        add(worst.time, off_phase(static_cast<double>(e.accessory(swing::t_min)[i]), -pi / 2));
        add(worst.integral, std::abs(static_cast<double>(e.accessory(swing::square)[i]) - integral_of_square(t)));
    }
    return worst;
}

template <class Method>
errors swing_errors(double tolerance, double span = 17) {
    auto e = swings<swing>(span);
    const auto report = solve<Method>(tests::test_device(), e, compare::with_tolerance(tolerance, 1.0 / 32));
    CHECK(report.failed() == 0);
    return errors_of(e);
}

template <class Test>
void each(Test test) {
    compare::each_method(test);
    const auto with_name = [&]<class Method>(const char* name) {
        INFO(name);
        test.template operator()<Method>();
    };
    with_name.template operator()<dormand_prince_5>("dormand_prince_5");
    with_name.template operator()<verner_7>("verner_7");
    with_name.template operator()<dormand_prince_8>("dormand_prince_8");
    with_name.template operator()<rosenbrock_23>("rosenbrock_23");
    with_name.template operator()<rodas_5p>("rodas_5p");
}

}  // namespace

TEST_CASE("the largest and smallest value of an oscillation are as good as the steps, not as their ends", "[summary]") {
    // docs/numerics/dense_output.md has this.
    each([]<class Method> {
        const errors error = swing_errors<Method>(1e-8);
        CHECK(error.extremum <= 2 * error.state);
        CHECK(error.extremum < 2e-7);
        // An extremum of height 1 is flat: its position is only known to the error of the slope.
        CHECK(error.time <= 20 * error.state);
        CHECK(error.time < 2e-5);
        CHECK(error.integral <= 17 * error.state);
    });
}

TEST_CASE("the largest value at ends of steps is off by the square of a step", "[summary]") {
    auto e = swings<plain_swing>();
    options o = compare::with_tolerance(1e-8);
    o.samples = {.states = {plain_swing::x}, .capacity = 200, .every = 1};
    solve<dense<dormand_prince_8>>(tests::test_device(), e, o);
    double worst = 0;
    for (std::int64_t i = 0; i < e.size(); ++i)
        worst = std::max(worst, 1 - e.samples().state(plain_swing::x).row(i).head(e.samples().stored()[i]).maxCoeff());
    CHECK(worst > 1e-2);  // docs/numerics/dense_output.md: 2.5e-2; h^2 / 8 for the steps of 0.5
    CHECK(worst < 3.2e-2);
}

TEST_CASE("extrema and integrals fall with the tolerance as the states do", "[summary]") {
    each([]<class Method> {
        if constexpr (Method::embedded_order > 0 && !std::is_same_v<Method, rosenbrock_23>) {
            const errors coarse = swing_errors<Method>(1e-6), fine = swing_errors<Method>(1e-10);
            CHECK(fine.extremum <= 1e-3 * coarse.extremum);
            CHECK(fine.integral <= 1e-3 * coarse.integral);
            CHECK(fine.extremum <= 2 * fine.state);
        }
    });
}

TEST_CASE("backwards in time extrema are the same and integrals negative", "[summary]") {
    each([]<class Method> {
        const errors error = swing_errors<Method>(1e-8, -17);
        CHECK(error.extremum <= 2 * error.state);
        CHECK(error.time <= 20 * error.state);
        CHECK(error.integral <= 17 * error.state);
    });
}

TEST_CASE("extrema and integrals are there in single precision", "[summary]") {
    const auto check = []<class Method> {
        auto e = swings<swing, float>();
        solve<Method>(tests::test_device(), e, compare::with_tolerance(1e-5));
        const errors error = errors_of(e);
        CHECK(error.extremum <= 2 * error.state + 1e-6);
        CHECK(error.time <= 1e-3);
        CHECK(error.integral <= 17 * error.state + 1e-5);
    };
    check.template operator()<cash_karp>();
    check.template operator()<dormand_prince_5>();
}

TEST_CASE("summaries change no bit of the states and no step", "[summary]") {
    compare::each_method([]<class Method> {
        auto with = swings<swing>();
        auto without = swings<plain_swing>();
        const options o = compare::with_tolerance(1e-7);
        solve<Method>(tests::test_device(), with, o);
        solve<Method>(tests::test_device(), without, o);
        for (const int c : {0, 1}) CHECK(compare::same_bits_everywhere(with.state(c), without.state(c)));
        CHECK((with.accepted_steps() == without.accepted_steps()).all());
        CHECK((with.rejected_steps() == without.rejected_steps()).all());
    });
}

TEST_CASE("what summaries evaluate is counted, and the slope at the end of a step is the next one's first",
          "[summary]") {
    const options o = compare::with_tolerance(1e-7);
    const auto evaluations = [&]<class Method, class Model> {
        auto e = swings<Model>();
        solve<Method>(tests::test_device(), e, o);
        return std::pair{e.rhs_evaluations().sum(), e.accepted_steps().sum()};
    };
    const std::int64_t instances = 11, extrema = 3 * instances;  // sin(t + from) has its maxima at 1.3, 7.6 and 13.8
    const auto plain = evaluations.template operator()<cash_karp, plain_swing>();
    const auto peak = evaluations.template operator()<cash_karp, peak_of_swing>();
    // The slope at the end of the last step, and one point inside each step that may have an extremum, also for minima.
    CHECK(peak.first - plain.first >= instances + extrema);
    CHECK(peak.first - plain.first <= instances + 2 * extrema);
    const auto all = evaluations.template operator()<cash_karp, swing>();
    CHECK(all.first - plain.first == instances + plain.second);  // an integral evaluates inside every step
    CHECK(evaluations.template operator()<tsitouras_5, peak_of_swing>() ==
          evaluations.template operator()<tsitouras_5, plain_swing>());
}

TEST_CASE("summaries begin anew with each phase, at its start", "[summary]") {
    const options o = compare::with_tolerance(1e-9);
    auto e = swings<swing>();
    e.t_end() = 1;
    options phases = o;
    phases.phases = 4;
    phases.phase_time = myriad::phase_time::restart;
    phases.record.accessories = {swing::x_max, swing::t_max, swing::x_min, swing::square};
    const auto report = solve<tsitouras_5>(tests::test_device(), e, phases);
    for (int k = 0; k < 4; ++k) {
        // Time begins at 0 in each phase: the state is sin(t + k + from).
        const double begin = k + from, end = begin + 1;
        const bool inside = begin < pi / 2 && end > pi / 2;
        const bool bottom = begin < 3 * pi / 2 && end > 3 * pi / 2;
        CHECK(report.records.accessory(swing::x_max)(0, k) ==
              Approx(inside ? 1 : std::max(std::sin(begin), std::sin(end))).margin(1e-7));
        CHECK(report.records.accessory(swing::t_max)(0, k) ==
              Approx(inside ? pi / 2 - begin : (std::sin(begin) > std::sin(end) ? 0 : 1)).margin(1e-6));
        CHECK(report.records.accessory(swing::x_min)(0, k) ==
              Approx(bottom ? -1 : std::min(std::sin(begin), std::sin(end))).margin(1e-7));
        CHECK(report.records.accessory(swing::square)(0, k) ==
              Approx(integral_of_square(k + 1) - integral_of_square(k)).margin(1e-7));
    }
    auto in_calls = swings<swing>();
    in_calls.t_end() = 1;
    for (int k = 0; k < 4; ++k) solve<tsitouras_5>(tests::test_device(), in_calls, o);
    CHECK(compare::difference(e, in_calls) == "");
}

TEST_CASE("a phase without a step has the values at its start", "[summary]") {
    auto e = swings<swing>();
    e.t_begin() = 2;
    e.t_end() = 2;
    solve<cash_karp>(tests::test_device(), e, compare::with_tolerance(1e-8));
    CHECK((e.accessory(swing::x_max) == e.state(swing::x)).all());
    CHECK((e.accessory(swing::x_min) == e.state(swing::x)).all());
    CHECK((e.accessory(swing::t_max) == 2.0).all());
    CHECK((e.accessory(swing::square) == 0.0).all());
}

TEST_CASE("samples and summaries do not disturb each other", "[summary]") {
    auto alone = swings<swing>(), sampled = swings<swing>();
    options o = compare::with_tolerance(1e-7);
    solve<cash_karp>(tests::test_device(), alone, o);
    o.samples = {.states = {swing::x}, .capacity = 500, .evenly = 500};
    solve<dense<cash_karp>>(tests::test_device(), sampled, o);
    for (int c = 0; c < swing::n_accessory; ++c)
        CHECK(compare::same_bits_everywhere(alone.accessory(c), sampled.accessory(c)));
    CHECK(compare::same_bits_everywhere(alone.state(0), sampled.state(0)));
    CHECK((alone.rhs_evaluations() == sampled.rhs_evaluations()).all());  // both need the slopes at the ends of steps
    CHECK((sampled.samples().state(swing::x).rowwise().maxCoeff() <= sampled.accessory(swing::x_max) + 1e-5).all());
}

TEST_CASE("one step can hold a maximum and a minimum, and a quantity may depend on time alone", "[summary]") {
    const auto check = []<class Method>(double begin, double end) {
        ensemble<timed> e(3);
        e.state(timed::y0) = 0;
        e.shared(timed::from) = std::min(begin, end);
        e.time_domain(begin, end);
        options o;
        o.step = 0.8;
        const auto report = solve<Method>(tests::test_device(), e, o);
        CHECK(report.accepted_steps == 3);  // one step each
        CHECK(e.accessory(timed::hill_max)[1] == Approx(1).epsilon(1e-14));
        CHECK(e.accessory(timed::hill_at)[1] == Approx(e.shared(timed::from) + 0.3).epsilon(1e-12));
        CHECK(e.accessory(timed::wave_max)[1] == Approx(0.00675).epsilon(1e-12));
        CHECK(e.accessory(timed::wave_min)[1] == Approx(-0.0845 / 6).epsilon(1e-12));
        CHECK(e.accessory(timed::slope_max)[1] == Approx(0.8).epsilon(1e-14));
        // Lobatto's rule is exact up to degree seven.
        CHECK(e.accessory(timed::fifth)[1] == Approx((end - begin) / 0.8 * std::pow(0.8, 6) / 6).epsilon(1e-13));
    };
    check.template operator()<tsitouras_5>(0, 0.8);
    check.template operator()<tsitouras_5>(0.8, 0);
    check.template operator()<tsitouras_5>(7, 7.8);
    check.template operator()<runge_kutta_4>(0, 0.8);
}

TEST_CASE("a quantity that never changes has its extremum at the start", "[summary]") {
    ensemble<timed> e(3);
    e.state(timed::y0) = 0;
    e.shared(timed::from) = 0;
    e.time_domain(0.6, 3);
    solve<tsitouras_5>(tests::test_device(), e, {.step = 0.1});
    CHECK(e.accessory(timed::level_max)[2] == 3);
    CHECK(e.accessory(timed::level_at)[2] == 0.6);
}

TEST_CASE("a quantity that is NaN on the way makes its own summaries NaN and no others", "[summary]") {
    ensemble<timed> e(3);
    e.state(timed::y0) = 0;
    e.shared(timed::from) = 0;
    e.time_domain(0, 3);  // log(2.5 - t)
    const auto report = solve<tsitouras_5>(tests::test_device(), e, {.step = 0.1});
    CHECK(report.failed() == 0);
    CHECK(std::isnan(e.accessory(timed::log_max)[0]));
    CHECK(std::isnan(e.accessory(timed::log_integral)[0]));
    CHECK(e.accessory(timed::slope_max)[0] == 3);
}

TEST_CASE("extrema never lie beyond an event, and the state that an action leaves counts", "[summary]") {
    compare::each_method([]<class Method> {
        ensemble<ball> e(5);
        e.state(ball::x) = 0.5;
        e.state(ball::v) = 1;
        e.shared(ball::lift) = 0;
        e.shared(ball::kept) = 1;
        e.time_domain(0, 10);
        options o = compare::with_tolerance(1e-10, 0.125);
        o.events = {{.direction = myriad::direction::falling, .tolerance = 1e-9, .stop_after = 3}};
        solve<Method>(tests::test_device(), e, o);
        CHECK(e.status(4) == myriad::status::stopped_by_event);
        CHECK(e.accessory(ball::height)[4] == Approx(1).epsilon(1e-9));  // in each flight, v^2 / 2 + x = 1
        CHECK(std::abs(std::remainder(e.accessory(ball::height_at)[4] - 1, 2 * std::sqrt(2.0))) < 1e-6);
        CHECK(e.accessory(ball::lowest)[4] >= -1e-9);
        CHECK(e.accessory(ball::lowest)[4] <= 1e-9);
        CHECK(e.accessory(ball::fastest)[4] == Approx(std::sqrt(2.0)).epsilon(1e-9));

        // The action puts the ball at rest at 2, higher than ever before; from there it falls until the phase ends.
        e.restart();
        e.state(ball::x) = 0.5;
        e.state(ball::v) = 0;
        e.shared(ball::lift) = 2;
        e.shared(ball::kept) = 0;
        e.time_domain(0, 1.5);
        o.events[0].stop_after = 0;
        solve<Method>(tests::test_device(), e, o);
        CHECK(e.accessory(ball::height)[4] == 2);
        CHECK(e.accessory(ball::height_at)[4] == Approx(1).epsilon(1e-8));
    });
}

TEST_CASE("a right-hand side may read what a summary writes, as what a hook writes", "[summary]") {
    const auto check = []<class Method> {
        ensemble<remembering> e(5);
        ensemble<remembering_by_hook> by_hook(5);
        const auto prepare = [](auto& of) {
            of.state(0) = 0.5;
            of.time_domain(0, 1);
        };
        prepare(e);
        prepare(by_hook);
        const options o = compare::with_tolerance(1e-6);
        solve<Method>(tests::test_device(), e, o);
        solve<Method>(tests::test_device(), by_hook, o);
        CHECK(e.state(0)[3] == by_hook.state(0)[3]);
        CHECK(e.accessory(0)[3] == by_hook.accessory(0)[3]);
        CHECK(e.accepted_steps()[3] == by_hook.accepted_steps()[3]);
    };
    check.template operator()<cash_karp>();
    check.template operator()<tsitouras_5>();
}

TEST_CASE("a summary leaves the steps after a hook's change of the state as they are without it", "[summary]") {
    const auto check = []<class Method> {
        ensemble<halved> alone(5);
        ensemble<halved_and_summed> summed(5);
        const auto solve_one = [](auto& of) {
            of.state(0) = 8.0;
            of.time_domain(0, 1);
            options o = compare::with_tolerance(1e-6);
            o.step = 0.1;
            solve<Method>(tests::test_device(), of, o);
        };
        solve_one(alone);
        solve_one(summed);
        CHECK(summed.state(0)[3] == alone.state(0)[3]);
        CHECK(summed.accepted_steps()[3] == alone.accepted_steps()[3]);
        CHECK(summed.accessory(halved_and_summed::area)[3] > 0);
    };
    check.template operator()<cash_karp>();
    check.template operator()<runge_kutta_4>();
}

TEST_CASE("a model with tangents keeps the summaries of its own", "[summary]") {
    auto e = swings<swing_with_tangents>();
    myriad::initial_tangents(e);
    auto alone = swings<swing>();
    options o = compare::with_tolerance(1e-8);
    solve<tsitouras_5>(tests::test_device(), alone, o);
    o.absolute_tolerance = o.relative_tolerance = myriad::without_tangents<swing_with_tangents>(1e-8);
    e.shared_integer(swing_with_tangents::transient_phases) = 0;
    solve<tsitouras_5>(tests::test_device(), e, o);
    for (int c = 0; c < swing::n_accessory; ++c) CHECK((e.accessory(c) - alone.accessory(c)).abs().maxCoeff() < 1e-13);
}
