// SPDX-License-Identifier: MIT
// Tangents pass events and hooks like differences of trajectories, and events and hooks act with tangents as they do
// without.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <Eigen/Dense>
#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/kernel/model/tangent_models.hpp"
#include "tests/kernel/model/tangent_vectors.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/device.hpp"

namespace {

using namespace tangents;
using compare::same_bits_everywhere;
using compare::with_tolerance;
using Eigen::ArrayXd;
using Eigen::Index;

/// x doubles after each step, and is multiplied by y at the start of each phase; its kernels are not compiled.
struct doubling {
    enum state { x, y, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return {s[x], s[y]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) { lane.y[x] *= lane.y[y]; }
    template <class R>
    MYRIAD_FUNCTION static myriad::mask_of<R> after_step(auto& lane) {
        lane.y[x] = R(2) * lane.y[x];
        return lane.y[x] > R(100);
    }
};

/// One instance without an integration, for calling hooks on it.
template <class W>
struct by_hand {
    myriad::detail::lane_data<W, double> data{};
    std::array<double, 2> shared{0.1, 0.05};
    std::array<std::int32_t, 2> shared_integer{0, 0};
    myriad::lane<W, double> lane{data};

    explicit by_hand(const std::array<double, W::n_state>& y) {
        std::copy(y.begin(), y.end(), data.y.values);
        data.shared = shared.data();
        data.shared_integer = shared_integer.data();
        lane.shared = data.shared;
        lane.shared_integer = data.shared_integer;
    }
    std::array<double, W::n_tangent> tangents() const {
        std::array<double, W::n_tangent> out;
        std::copy_n(data.y.values + W::n_original, W::n_tangent, out.begin());
        return out;
    }
};

const myriad::options table_events = [] {
    myriad::options o = with_tolerance(1e-12);
    o.events = {{.direction = myriad::direction::falling, .tolerance = 1e-11}, {.tolerance = 1e-11}};
    return o;
}();

template <class Model>
void fill_table(myriad::ensemble<Model>& e) {
    e.parameter(table::r).setLinSpaced(0.85, 1.0);
    e.shared(table::amplitude) = 0.1;
    e.shared(table::drag) = 0.05;
    e.state(table::x) = ArrayXd::LinSpaced(e.size(), 1, 1.3);
    e.state(table::v) = ArrayXd::LinSpaced(e.size(), -0.2, 0.1);
    e.time_domain(0, 8);
}

}  // namespace

TEST_CASE("tangents pass impacts on a moving table as the differences of trajectories do") {
    using W = table_spectrum;
    myriad::ensemble<W> e(24);
    fill_table(e);
    for (int c = 0; c < 2; ++c)  // instances alternate in which direction comes first
        for (int i = 0; i < 2; ++i)
            for (Index k = 0; k < e.size(); ++k) e.state(W::tangent(c, i))[k] = (c + i + k) % 2 == 0 ? 1 : 0;
    // Central differences, d = 1e-5: their error is of order d^2, plus the error of steps and events, 1e-10, over d.
    const double d = 1e-5;
    const auto shifted = [&](double sign) {
        myriad::ensemble<table> alone(e.size());
        fill_table(alone);
        for (Index k = 0; k < e.size(); ++k) alone.state(k % 2 == 0 ? table::x : table::v)[k] += sign * d;
        myriad::solve<myriad::tsitouras_5>(tests::test_device(), alone, table_events);
        return alone;
    };
    const auto up = shifted(1), down = shifted(-1);
    const auto report = myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, table_events);
    REQUIRE(report.count(myriad::status::success) == e.size());
    for (Index k = 0; k < e.size(); ++k) {
        const auto bounces = e.integer_accessory(table::bounces)[k];
        CAPTURE(k, bounces);
        CHECK(bounces >= 2);
        const auto difference = [&](int c) { return (up.state(c)[k] - down.state(c)[k]) / (2 * d); };
        const Eigen::Vector2d expected(difference(table::x), difference(table::v));
        CHECK((first_tangent(e, k) - expected).norm() <= 2e-5 * (1 + expected.norm()));
        // Areas: an impact multiplies them by r^2, drag does the rest; exact except for the errors of steps and events.
        const double growth = e.accessory(W::growth(0))[k] + e.accessory(W::growth(1))[k];
        CHECK(std::abs(growth - (2 * bounces * std::log(e.parameter(table::r)[k]) - 0.05 * 8)) <= 1e-8);
    }
}

// The tangents' model declares its accessories outputs, the one without tangents does not: no bit depends on that
// either.
TEST_CASE("hooks and events do with tangents what they do without, at the ends of phases too") {
    // Of 400 phases many end while an event function is within such a tolerance.
    myriad::options o = with_tolerance(1e-9);
    o.events = {{.direction = myriad::direction::falling, .tolerance = 1e-2}, {.tolerance = 1e-2}};
    o.phase_time = myriad::phase_time::carry_on;
    o.step = 1e-3;
    myriad::ensemble<table> alone(48);
    myriad::ensemble<table_spectrum> e(48);
    const auto run = [&](auto& instances) {
        fill_table(instances);
        instances.shared_integer(table::bounces_allowed) = 3;
        for (int k = 1; k <= 400; ++k) {
            instances.t_end() = 0.02 * k;
            myriad::solve<myriad::tsitouras_5>(tests::test_device(), instances, o);
        }
    };
    run(alone);
    myriad::initial_tangents(e);
    o.relative_tolerance = o.absolute_tolerance = myriad::without_tangents<table_spectrum>(1e-9);
    run(e);
    CHECK((e.phases_done() == alone.phases_done()).all());
    CHECK((e.integer_accessory(table::bounces) == alone.integer_accessory(table::bounces)).all());
    CHECK((e.integer_accessory(table::phases) == alone.integer_accessory(table::phases)).all());
    CHECK(e.phases_done().minCoeff() < 400);  // some are ended by their hook
    if (!tests::tests_cpu()) return;
    for (int c = 0; c < table::n_state; ++c) CHECK(same_bits_everywhere(e.state(c), alone.state(c)));
    for (int c = 0; c < table::n_accessory; ++c) CHECK(same_bits_everywhere(e.accessory(c), alone.accessory(c)));
}

TEST_CASE("tangents made orthonormal between phases do not make an event function forget its side") {
    // It is below zero, within its tolerance, while a phase ends, and rises again: one crossing.
    using W = myriad::with_tangents<dip>;
    myriad::ensemble<W> e(4);
    e.state(dip::x) = 0.995;
    e.state(dip::w) = 1;
    myriad::initial_tangents(e);
    myriad::options o = with_tolerance(1e-10);
    o.phase_time = myriad::phase_time::carry_on;
    o.events = {{.direction = myriad::direction::rising, .tolerance = 0.01}};
    for (const double t_end : {0.97, 2.0}) {
        e.time_domain(0, t_end);
        myriad::solve<myriad::cash_karp>(tests::test_device(), e, o);
    }
    CHECK((e.state(dip::x) - 0.995).abs().maxCoeff() <= 1e-9);
    CHECK((e.integer_accessory(dip::crossings) == 1).all());
}

TEST_CASE("a change of mode and a map at the end of a phase move the tangent") {
    using W = myriad::with_tangents<gear>;
    myriad::ensemble<W> e(10);
    e.state(gear::x) = -1;
    e.parameter(gear::speed).setLinSpaced(2, 4);
    e.state(W::tangent(gear::x)) = 1;
    e.time_domain(0, 1.5);
    myriad::options o = with_tolerance(1e-9);
    o.maximum_step = 0.0625;
    const auto growth_of_phase = [&] {
        const ArrayXd before = e.accessory(W::growth());
        myriad::solve<myriad::cash_karp>(tests::test_device(), e, o);
        return ArrayXd(e.accessory(W::growth()) - before);
    };
    e.accessory(W::growth()) = 0;
    // At twice the speed distances double; then finalise multiplies x by three. Exact up to some roundings.
    CHECK((growth_of_phase() - (3 * e.parameter(gear::speed)).log()).abs().maxCoeff() <= 1e-14);
    CHECK((e.state(gear::x) - 1.5 * e.parameter(gear::speed)).abs().maxCoeff() <= 1e-5);  // located to 1e-6
    CHECK((growth_of_phase() - std::log(3.0)).abs().maxCoeff() <= 1e-14);
    CHECK((e.accessory(W::time_summed) < 3).any());  // where after_step has ended the phase
    CHECK((e.t() - 1.5).abs().minCoeff() == 0);
}

TEST_CASE("a direction that is lost altogether ends the instance") {
    using W = myriad::with_tangents<gear>;
    myriad::ensemble<W> e(2);
    e.state(gear::x) = -1;
    e.parameter(gear::speed) << 0, 1;  // at rest from x = 0 on, wherever it began
    myriad::initial_tangents(e);
    e.time_domain(0, 1.5);
    myriad::solve<myriad::cash_karp>(tests::test_device(), e, with_tolerance(1e-9));
    CHECK(e.status(0) == myriad::status::not_finite);
    CHECK(e.status(1) == myriad::status::success);
}

TEST_CASE("actions that only record leave tangents alone, to the bit, even where a surface is only touched") {
    by_hand<table_spectrum> flight({0.4, 0, 0.6, 0.8, -0.8, 0.6});
    flight.data.t = 1;
    flight.data.parameter = {0.9};
    flight.data.accessory[table::highest] = 0.3;
    table_spectrum::after_event(table::apex, flight.lane);
    CHECK(flight.data.accessory[table::highest] == 0.4);
    CHECK(flight.tangents() == std::array{0.6, 0.8, -0.8, 0.6});

    using W = myriad::with_tangents<dip>;
    by_hand<W> touch({0, 1, 0.6, 0.8});
    touch.data.t = 1;
    touch.data.integer_accessory[dip::crossings] = 0;
    W::after_event(dip::zero, touch.lane);
    CHECK(touch.data.integer_accessory[dip::crossings] == 1);
    CHECK(touch.tangents() == std::array{0.6, 0.8});

    // An impact that only touches has no derivative.
    by_hand<table_spectrum> rest({0, 0, 0.6, 0.8, -0.8, 0.6});
    rest.shared = {0, 0};
    rest.data.t = 1;
    rest.data.parameter = {0.9};
    table_spectrum::after_event(table::impact, rest.lane);
    CHECK(std::isnan(rest.tangents()[1]));
}

TEMPLATE_TEST_CASE("an impact moves tangents by its saltation matrix", "", table, recording_table) {
    using W = myriad::with_tangents<TestType, 2>;
    // Of a table at rest: x -> -r x and v -> -r v, v -> v + (1 + r) x f / v, from the textbook formula with f = -1.
    const double r = 0.75, v = -2;
    by_hand<W> ball({0, v, 1, 0, 0, 1});
    ball.shared = {0, 0};
    ball.data.t = 1;
    ball.data.parameter = {r};
    ball.data.integer_accessory = {0, 0};
    W::after_event(table::impact, ball.lane);
    CHECK(ball.data.y[table::v] == -r * v);
    const std::array<double, 4> expected{-r, (1 + r) * -1 / v, 0, -r};  // exact in binary
    CHECK(ball.tangents() == expected);
}

TEST_CASE("hooks that change the state move the tangents") {
    using W = myriad::with_tangents<doubling, 2>;
    by_hand<W> two({3, 5, 1, 0, 0, 1});
    two.data.phase = 1;
    two.data.t = two.data.t_begin = 0;
    CHECK(!W::after_step<double>(two.lane));
    CHECK(two.data.y[doubling::x] == 6);
    CHECK(two.tangents() == std::array<double, 4>{2, 0, 0, 1});
    W::initialise(two.lane);
    CHECK(two.data.y[doubling::x] == 30);  // times y
    CHECK(two.tangents() == std::array<double, 4>{10, 0, 6, 1});
    by_hand<W> start({30, 5, 0.6, 0.8, -0.8, 0.6});
    start.data.t = start.data.t_begin = 0;
    start.data.phase = 0;  // so that initialise sets the start, and tangents begin as given
    W::initialise(start.lane);
    CHECK(start.data.y[doubling::x] == 150);
    CHECK(std::abs(start.tangents()[0] - 0.6) <= 4e-16);  // two divisions and a root
    CHECK(std::abs(start.tangents()[1] - 0.8) <= 4e-16);
}
