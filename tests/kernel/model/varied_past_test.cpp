// SPDX-License-Identifier: MIT
// Sensitivities of models with delays against differences, and the largest exponent of one against its closed form.
#include "myriad/kernel/model/varied_past.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <myriad/myriad.hpp>
#include <myriad/sensitivity.hpp>
#include <myriad/tangent.hpp>

#include "tests/catch.hpp"
#include "tests/kernel/model/varied_past_models.hpp"
#include "tests/support/device.hpp"

namespace {

using myriad::ensemble;
using myriad::options;
using myriad::solve;
using myriad::status;

constexpr int tau = varied::smooth::tau, a = varied::smooth::a;

/// Instances that differ in delay and factor: instance i has tau[0] + tau[1] i, and a likewise.
struct values {
    double tau[2] = {0.9, 0.07}, a[2] = {1.3, -0.04};
};
template <class Model>
void set(ensemble<Model>& e, const values& of = {}, double more_tau = 0, double more_a = 0) {
    for (int i = 0; i < 11; ++i) {
        e.parameter(tau)[i] = of.tau[0] + of.tau[1] * i + more_tau;
        e.parameter(a)[i] = of.a[0] + of.a[1] * i + more_a;
    }
    e.state(0) = 0.7;
    e.time_domain(0, 5.5);
}
template <class Model, class Method>
ensemble<Model> solved(const options& o, const values& of, double more_tau, double more_a) {
    ensemble<Model> e(11);
    set(e, of, more_tau, more_a);
    solve<Method>(tests::test_device(), e, o);
    return e;
}
/// Differences of order 4, wide enough for what is not smooth in the numerical solution, as where steps end.
template <class Model, class Method>
void check_sensitivities(const options& o, double error, double h = 2e-3, const values& of = {}) {
    using by = myriad::with_sensitivities<Model, Model::tau, Model::a>;
    ensemble<by> e(11);
    set(e, of);
    myriad::initial_sensitivities(e);
    solve<Method>(tests::test_device(), e, o);
    for (const bool by_tau : {true, false}) {
        const auto at = [&](double d) { return solved<Model, Method>(o, of, by_tau ? d : 0, by_tau ? 0 : d); };
        const auto far = at(2 * h), near = at(h), below = at(-h), far_below = at(-2 * h);
        for (int i = 0; i < 11; ++i) {
            REQUIRE(e.status(i) == status::success);
            const double expected =
                (8 * (near.state(0)[i] - below.state(0)[i]) - (far.state(0)[i] - far_below.state(0)[i])) / (12 * h);
            const double found = e.state(by::sensitivity(0, by_tau ? 0 : 1))[i];
            CAPTURE(i, by_tau, expected, found);
            CHECK(std::abs(found - expected) <= error * (1 + std::abs(expected)));
        }
    }
}
options tolerance(double size) {
    options o;
    o.relative_tolerance = o.absolute_tolerance = size;
    o.history_steps = 1024;
    return o;
}

}  // namespace

TEST_CASE("sensitivities by a parameter and by the delay itself") {
    options o;
    o.step = 1.0 / 64;
    check_sensitivities<varied::smooth, myriad::runge_kutta_4>(o, 1e-5);
    check_sensitivities<varied::smooth, myriad::rodas_5p>(tolerance(1e-9), 1e-5);
}
TEST_CASE("sensitivities jump where the beginning arrives at another time") {
    check_sensitivities<varied::jumping, myriad::dormand_prince_5>(tolerance(1e-11), 1e-6);
    check_sensitivities<varied::jumping, myriad::cash_karp>(tolerance(1e-10), 1e-5);
}
TEST_CASE("sensitivities through events that see the past, and jumps that are seen a delay later") {
    check_sensitivities<varied::kicked, myriad::dormand_prince_5>(tolerance(1e-11), 2e-6, 2e-4);  // the same events
}
TEST_CASE("sensitivities with a lag that depends on time and state") {
    check_sensitivities<varied::bent, myriad::dormand_prince_5>(tolerance(1e-11), 1e-5);
    // The beginning arrives: t - lag is above zero at the end.
    check_sensitivities<varied::bent, myriad::dormand_prince_5>(tolerance(1e-11), 1e-5, 1e-3,
                                                                {{0.5, 0.02}, {0.2, 0.03}});
}
TEST_CASE(
    "sensitivities where a stop strikes, an event that does nothing is at the same time, or a jump arrives then") {
    const values apart{{0.9, 0.07}, {1.3, 0.04}}, together{{1, 0.05}, {1, 0.05}}, train{{0.5, 0.03}, {1, 0.06}};
    for (const values& of : {apart, together, train})
        check_sensitivities<varied::struck, myriad::dormand_prince_5>(tolerance(1e-11), 2e-6, 1e-3, of);
}
TEST_CASE("a past that would move by another time in neighbouring solutions has no derivatives") {
    using by = myriad::with_sensitivities<varied::kicked, varied::kicked::tau, varied::kicked::a>;
    ensemble<by> e(11);
    set(e);
    myriad::initial_sensitivities(e);
    options o = tolerance(1e-9);
    o.phases = 2;
    o.events = {{.stop_after = 1}};
    solve<myriad::dormand_prince_5>(tests::test_device(), e, o);
    for (int i = 0; i < 11; ++i) CHECK(e.status(i) == status::not_finite);
}
TEST_CASE("the growth of a tangent with delays and events does not depend on the phases") {
    using tangent = myriad::with_tangents<varied::kicked>;
    const auto growth = [](int phases) {
        ensemble<tangent> e(11);
        set(e);
        myriad::initial_tangents(e);
        e.time_domain(0, std::numeric_limits<double>::infinity());
        e.shared_integer(tangent::transient_phases) = 0;
        options o = tolerance(1e-10);
        o.phases = phases;
        o.phase_length = 6.0 / phases;
        solve<myriad::dormand_prince_5>(tests::test_device(), e, o);
        std::vector<double> of;
        for (int i = 0; i < 11; ++i) {
            REQUIRE(e.status(i) == status::success);
            of.push_back(e.accessory(tangent::growth())[i]);
        }
        return of;
    };
    const auto whole = growth(1), parts = growth(6);
    for (std::size_t i = 0; i < 11; ++i) CHECK(std::abs(parts[i] - whole[i]) < 1e-6);
}
TEST_CASE("the largest exponent of a delayed equation is the real part of Lambert's W") {
    using tangent = myriad::with_tangents<varied::exponential>;
    constexpr double rate[] = {1, -0.3}, exponent[] = {0.5671432904097838, -0.4894022271802149};
    ensemble<tangent> e(2);
    for (int i = 0; i < 2; ++i) e.parameter(varied::exponential::c)[i] = rate[i];
    e.state(0) = 0;
    myriad::initial_tangents(e);
    e.shared_integer(tangent::transient_phases) = 20;
    e.time_domain(0, std::numeric_limits<double>::infinity());
    options o = tolerance(1e-9);
    o.phases = 420;  // without a common scale of tangent and past it would grow beyond all numbers
    o.phase_length = 4;
    solve<myriad::dormand_prince_5>(tests::test_device(), e, o);
    for (int i = 0; i < 2; ++i) {
        REQUIRE(e.status(i) == status::success);
        CHECK(std::abs(e.accessory(tangent::exponent())[i] - exponent[i]) < 1e-7);
    }
}
