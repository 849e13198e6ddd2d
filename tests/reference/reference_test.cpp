// SPDX-License-Identifier: MIT
// End values computed in quadruple precision or known in closed form, for every method: errors within the bound that
// the tolerance implies, decreasing with it.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/device.hpp"
#include "tests/support/problems.hpp"

namespace {

using compare::each_adaptive_method;
using myriad::device;
using myriad::direction;
using myriad::ensemble;
using myriad::options;
using myriad::runge_kutta_4;
using myriad::solve;
using myriad::status;

constexpr double eps = std::numeric_limits<double>::epsilon();

template <class Model>
struct reference {
    std::vector<double> start;
    double t_end;
    std::vector<double> end;
    /// The factor by which an error of one step may have grown by the end: the largest norm of dy(t_end)/dy(t) times
    /// the scale max(1, |y(t)|) of the tolerance, from the variational equation (0.1 % accurate) or, for A1 to A4, in
    /// closed form.
    double growth;
    std::vector<double> parameters = {};
};

template <class Method, class Model>
struct result {
    double error;
    std::vector<double> end;
    double steps;

    result(const reference<Model>& r, const options& o, const device& where = tests::test_device(1))
        : error(0), end(r.start.size()) {
        ensemble<Model> e(1);
        for (std::size_t c = 0; c < r.start.size(); ++c) e.state(static_cast<int>(c)) = r.start[c];
        for (std::size_t c = 0; c < r.parameters.size(); ++c) e.parameter(static_cast<int>(c)) = r.parameters[c];
        e.time_domain(0, r.t_end);
        solve<Method>(where, e, o);
        REQUIRE(e.status(0) == status::success);
        for (std::size_t c = 0; c < r.end.size(); ++c) {
            end[c] = e.state(static_cast<int>(c))[0];
            error = std::max(error, std::abs(end[c] - r.end[c]));
        }
        steps = static_cast<double>(e.accepted_steps()[0]);
    }
};

/// Adaptive methods. Every step adds an error below the tolerance, since the solution is more accurate than the one
/// whose error is estimated; rounding adds half an ulp a step. In the end the error is proportional to the tolerance.
template <class Model>
void check_tolerances(const reference<Model>& r) {
    each_adaptive_method([&]<class Method> {
        double first = 0;
        for (const double tolerance : {1e-5, 1e-7, 1e-9, 1e-11}) {
            const result<Method, Model> run(r, compare::with_tolerance(tolerance, 0.01));
            CAPTURE(tolerance, run.steps, run.error);
            CHECK(run.error <= r.growth * run.steps * (tolerance + eps));
            // Roughly in proportion: errors of one sign may meet errors of the other.
            if (first == 0) first = run.error;
            CHECK(run.error <= 10 * (tolerance / 1e-5) * first + r.growth * run.steps * eps);
        }
    });
}

/// Fixed steps. The difference of two step sizes gives the error of the finer one, 1/15 of it for order four, up to a
/// term in h; and halving the step divides the error by 16.
template <class Model>
void check_fixed_steps(const reference<Model>& r, double h) {
    options o;
    o.step = h;
    const result<runge_kutta_4, Model> coarse(r, o);
    o.step = h / 2;
    const result<runge_kutta_4, Model> fine(r, o);
    double difference = 0;
    for (std::size_t c = 0; c < r.end.size(); ++c)
        difference = std::max(difference, std::abs(coarse.end[c] - fine.end[c]));
    CAPTURE(h, coarse.error, fine.error, difference);
    REQUIRE(fine.error > 100 * eps);  // clear of rounding, or it proves nothing
    CHECK(std::abs(fine.error / (difference / 15) - 1) < 0.1);
    CHECK(std::abs(std::log2(coarse.error / fine.error) - 4) < 0.15);
    CHECK(std::abs(fine.steps - std::ceil(r.t_end / o.step - 1e-6)) < 0.5);
}

/// The device under test against the CPU. With fixed steps both do the same work and differ by rounding: that of fused
/// or separate products in some ten operations per component and step, each within half an ulp. Step sizes that differ
/// in the fifth digit are equally good: results differ by at most twice their error, and the step count may change
/// slightly.
template <class Model>
void check_backends(const reference<Model>& r, double h) {
    const auto difference = [](const std::vector<double>& a, const std::vector<double>& b) {
        double largest = 0;
        for (std::size_t c = 0; c < a.size(); ++c) largest = std::max(largest, std::abs(a[c] - b[c]));
        return largest;
    };
    options o;
    o.step = h;
    const result<runge_kutta_4, Model> here(r, o), there(r, o, device::cpu(1));
    CHECK(here.steps == there.steps);
    CHECK(difference(here.end, there.end) <= r.growth * here.steps * 5 * eps);
    each_adaptive_method([&]<class Method> {
        for (const double tolerance : {1e-6, 1e-10}) {
            const options adaptive = compare::with_tolerance(tolerance, 0.01);
            const result<Method, Model> on_device(r, adaptive), on_cpu(r, adaptive, device::cpu(1));
            CAPTURE(tolerance, on_device.steps, on_cpu.steps);
            CHECK(difference(on_device.end, on_cpu.end) <= 2 * r.growth * on_cpu.steps * (tolerance + eps));
            CHECK(std::abs(on_device.steps - on_cpu.steps) <= std::max(1.0, 0.03 * on_cpu.steps));
        }
    });
}

const reference<problems::decay> a1{{1}, 20, {2.061153622438557828e-9}, 1};
const reference<problems::power_decay> a2{{1}, 20, {0.21821789023599238127}, 1};
// A3: dy(T)/dy(t) = exp(sin T - sin t), scale at most exp(sin t): their product is exp(sin 20) or less than e^2 where
// the scale is one
const reference<problems::modulated_growth> a3{{1}, 20, {2.4916502718504145235}, 7.4};
// A4: dy(T)/dy(t) = f(y(T)) / f(y(t)), largest from the start: f(17.73) / f(1) = 2.12, times scales up to 17.73
const reference<problems::logistic> a4{{1}, 20, {17.730166481314839849}, 2.12 * 17.74};
// Lorenz at rho = 21 spirals into a fixed point after a chaotic transient.
const reference<problems::lorenz> lorenz_1{
    {1, 0, 0}, 1, {-6.4505791473189070092, -8.8952114786677926266, 14.649145866604444939}, 53, {21}};
const reference<problems::lorenz> lorenz_10{
    {1, 0, 0}, 10, {-7.8734410765709620402, -6.7133208531654644431, 22.176159652834202702}, 70, {21}};
const reference<problems::forced_duffing> duffing{{0.1, 0}, 50, {1.1702802239391576732, 0.065504462499426847300}, 22};
const reference<problems::van_der_pol> van_der_pol{{2, 0}, 20, {2.0081497621749485920, -0.042508875273202146986}, 6.3};

constexpr double period = 2.0074035758801301205;

/// The pendulum from rest at 0.05 until its speed has passed zero `count` times in the given direction.
template <class Method>
double turning_time(direction wanted, std::int64_t count, const options& how, double& steps) {
    ensemble<problems::pendulum> e(1);
    e.state(problems::pendulum::angle) = 0.05;
    e.state(problems::pendulum::speed) = 0.0;
    e.time_domain(0, 100);
    options o = how;
    o.events.resize(1);
    o.events[0].direction = wanted;
    o.events[0].tolerance = 1e-13;
    o.events[0].stop_after = count;
    const auto r = solve<Method>(tests::test_device(1), e, o);
    REQUIRE(r.count(status::stopped_by_event) == 1);
    steps = static_cast<double>(e.accepted_steps()[0]);
    return e.t()[0];
}

template <class Method>
void check_turning_time(direction wanted, std::int64_t count, double expected) {
    double before = 0;
    for (const double tolerance : {1e-8, 1e-10, 1e-12}) {
        double steps;
        const double error =
            std::abs(turning_time<Method>(wanted, count, compare::with_tolerance(tolerance, 1e-3), steps) - expected);
        CAPTURE(tolerance, steps, error);
        // An error of the state grows by at most 3.3 (as above), and becomes an error in time when divided by the
        // acceleration 9.8 sin 0.05 = 0.49 at the turning point, as does the event tolerance.
        CHECK(error <= (3.3 * steps * (tolerance + eps) + 1e-13) / 0.489);
        if (before > 0) CHECK(error < 0.1 * before + (3.3 * steps * eps + 1e-13) / 0.489);
        before = error;
    }
}

}  // namespace

TEST_CASE("DETEST A1 ends at its reference value within what the tolerance implies") { check_tolerances(a1); }
TEST_CASE("DETEST A2 ends at its reference value within what the tolerance implies") { check_tolerances(a2); }
TEST_CASE("DETEST A3 ends at its reference value within what the tolerance implies") { check_tolerances(a3); }
TEST_CASE("DETEST A4 ends at its reference value within what the tolerance implies") { check_tolerances(a4); }
TEST_CASE("Lorenz at t = 1 ends at its reference value within what the tolerance implies") {
    check_tolerances(lorenz_1);
}
TEST_CASE("Lorenz at t = 10 ends at its reference value within what the tolerance implies") {
    check_tolerances(lorenz_10);
}
TEST_CASE("Duffing at t = 50 ends at its reference value within what the tolerance implies") {
    check_tolerances(duffing);
}
TEST_CASE("van der Pol at t = 20 ends at its reference value within what the tolerance implies") {
    check_tolerances(van_der_pol);
}

TEST_CASE("DETEST A1 with a relative tolerance alone ends at its reference value, however small") {
    each_adaptive_method([]<class Method> {
        for (const double tolerance : {1e-5, 1e-8, 1e-11}) {
            options o = compare::with_tolerance(tolerance);
            o.absolute_tolerance = 1e-30;
            const result<Method, problems::decay> run(a1, o);
            // y' = -y: relative errors of the steps add up, and max(|y|, |y1|) is at most e^h |y1|
            CAPTURE(tolerance, run.steps, run.error);
            CHECK(run.error <= run.steps * 3 * (tolerance + eps) * a1.end[0]);
        }
    });
}

TEST_CASE("runge_kutta_4 approaches DETEST A1 with order four") {
    check_fixed_steps<problems::decay>({{1}, 1, {std::exp(-1.0)}, 1}, 0.02);
}
TEST_CASE("runge_kutta_4 approaches DETEST A2 with order four") { check_fixed_steps(a2, 0.025); }
TEST_CASE("runge_kutta_4 approaches DETEST A3 with order four") { check_fixed_steps(a3, 0.05); }
TEST_CASE("runge_kutta_4 approaches DETEST A4 with order four") { check_fixed_steps(a4, 0.1); }
TEST_CASE("runge_kutta_4 approaches Lorenz at t = 1 with order four") { check_fixed_steps(lorenz_1, 0.002); }
TEST_CASE("runge_kutta_4 approaches Lorenz at t = 10 with order four") { check_fixed_steps(lorenz_10, 0.002); }
TEST_CASE("runge_kutta_4 approaches Duffing at t = 50 with order four") { check_fixed_steps(duffing, 0.01); }
TEST_CASE("runge_kutta_4 approaches van der Pol at t = 20 with order four") { check_fixed_steps(van_der_pol, 0.01); }

TEST_CASE("the device under test agrees with the CPU on every problem, to what rounding and tolerance imply") {
    SECTION("DETEST A1") { check_backends(a1, 0.02); }
    SECTION("DETEST A2") { check_backends(a2, 0.025); }
    SECTION("DETEST A3") { check_backends(a3, 0.05); }
    SECTION("DETEST A4") { check_backends(a4, 0.1); }
    SECTION("Lorenz at t = 1") { check_backends(lorenz_1, 0.002); }
    SECTION("Lorenz at t = 10") { check_backends(lorenz_10, 0.002); }
    SECTION("Duffing") { check_backends(duffing, 0.01); }
    SECTION("van der Pol") { check_backends(van_der_pol, 0.01); }
}

TEST_CASE("the pendulum's period is the time to its second turning point") {
    each_adaptive_method([]<class Method> { check_turning_time<Method>(direction::falling, 1, period); });
}
TEST_CASE("half the pendulum's period is the time to its first turning point, and not to the one it starts at") {
    each_adaptive_method([]<class Method> {
        check_turning_time<Method>(direction::either, 1, period / 2);
        check_turning_time<Method>(direction::rising, 1, period / 2);
    });
}
TEST_CASE("three periods of the pendulum are three times its period") {
    each_adaptive_method([]<class Method> { check_turning_time<Method>(direction::falling, 3, 3 * period); });
}
TEST_CASE("runge_kutta_4 finds the pendulum's period with order four") {
    double steps;
    options o;
    o.step = 0.04;
    const double coarse = turning_time<runge_kutta_4>(direction::falling, 1, o, steps);
    o.step = 0.02;
    const double fine = turning_time<runge_kutta_4>(direction::falling, 1, o, steps);
    // The last step is shortened to the event, which disturbs the order by its share of the error: one step in fifty.
    CHECK(std::abs(std::log2(std::abs(coarse - period) / std::abs(fine - period)) - 4) < 0.3);
    o.step = 0.001;
    // error 20^4 times smaller than that of the fine one
    CHECK(std::abs(turning_time<runge_kutta_4>(direction::falling, 1, o, steps) - period) <
          2 * std::abs(fine - period) / 160000 + (3.3 * steps * eps + 1e-13) / 0.489);
}
