// SPDX-License-Identifier: MIT
// Coupled units are the system that they stand for: written as a whole, summed by a matrix library, solved by hand.
#include "myriad/kernel/model/coupled_units.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include <Eigen/Dense>
#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/kernel/model/unit_models.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/device.hpp"
#include "tests/support/message_of.hpp"

namespace {

using tests::message_of;

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using units::ball;
using units::oscillator;
using units::phase_oscillator;

/// Different parameters and states everywhere, for both ways to write the ring.
template <class Model, class R, int n>
void fill_ring(myriad::ensemble<Model, R>& e) {
    using spread = Eigen::Array<R, Eigen::Dynamic, 1>;
    e.parameter(0) = spread::LinSpaced(e.size(), R(0.05), R(0.3));
    e.shared(0) = R(0.4);
    for (int i = 0; i < n; ++i) {
        e.parameter(1 + i) = spread::LinSpaced(e.size(), R(1) + R(0.1) * R(i), R(2));
        e.shared(1 + i) = R(0.2) * R(i % 3);
        e.state(2 * i) = spread::LinSpaced(e.size(), R(-1), R(1) / R(i + 1));
        e.state(2 * i + 1) = R(0.1) * R(i % 5);
    }
    e.time_domain(0, 5);
}

/// Whether both have the same states: to the bit on the CPU, whose arithmetic is as written, else to what the compiler
/// changes, some rounding errors per step.
template <class A, class B, class R>
void check_same(const myriad::ensemble<A, R>& a, const myriad::ensemble<B, R>& b) {
    const R allowed = tests::tests_cpu() ? R(0) : R(1e4) * std::numeric_limits<R>::epsilon();
    for (Index i = 0; i < a.size(); ++i) {
        REQUIRE(a.status(i) == myriad::status::success);
        for (int c = 0; c < A::n_state; ++c) {
            CAPTURE(i, c);
            CHECK(std::abs(a.state(c)[i] - b.state(c)[i]) <= allowed);
        }
    }
}

template <class Method, int n>
void compare_rings(double tolerance) {
    myriad::ensemble<units::ring<n>> of_units(11);
    myriad::ensemble<units::whole_ring<n>> whole(11);
    fill_ring<units::ring<n>, double, n>(of_units);
    fill_ring<units::whole_ring<n>, double, n>(whole);
    myriad::solve<Method>(tests::test_device(), of_units, compare::with_tolerance(tolerance));
    myriad::solve<Method>(tests::test_device(), whole, compare::with_tolerance(tolerance));
    check_same(of_units, whole);
}

/// A right-hand side called by hand, with the shared values of an ensemble and parameters of its first instance.
template <class W>
std::array<double, W::n_state> slopes_of(const myriad::ensemble<W>& e) {
    myriad::inputs<W, double> p;
    for (int i = 0; i < W::n_parameter; ++i) p.parameter[i] = e.parameter(i)[0];
    std::array<double, W::n_shared> shared;
    for (int i = 0; i < W::n_shared; ++i) shared[static_cast<std::size_t>(i)] = e.shared(i);
    p.shared = shared.data();
    p.shared_integer = static_cast<const std::int32_t*>(nullptr);
    myriad::vec<double, W::n_state> y;
    for (int c = 0; c < W::n_state; ++c) y[c] = e.state(c)[0];
    const auto slopes = W::template rhs<double>(0.0, y, p);
    std::array<double, W::n_state> out;
    for (int c = 0; c < W::n_state; ++c) out[static_cast<std::size_t>(c)] = slopes[c];
    return out;
}

template <int n>
MatrixXd circulant(const Eigen::VectorXd& weights, int first) {
    MatrixXd m = MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < weights.size(); ++k) m(i, (i + first + k + n) % n) = weights[k];
    return m;
}

/// Random, but the same every time.
template <int n>
struct phase_matrices {
    MatrixXd full = (std::srand(5), MatrixXd::Random(n, n)), banded = MatrixXd::Random(n, n),
             ring = circulant<n>(Eigen::VectorXd::Random(3), -1),
             all_round = circulant<n>(Eigen::VectorXd::Random(n), 0);
    phase_matrices() {
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j)
                if (std::abs(i - j) > 2) banded(i, j) = 0;
    }
};

template <int n>
myriad::ensemble<units::phases<n>> phases_with(const phase_matrices<n>& m, std::int64_t size = 1) {
    using W = units::phases<n>;
    myriad::ensemble<W> e(size);
    for (int i = 0; i < n; ++i) {
        e.state(W::state_of(i, phase_oscillator::phase)) = 0.3 * i + 0.01;
        e.state(W::state_of(i, phase_oscillator::lag)) = 0.1 * i;
        e.parameter(W::parameter_of(i, phase_oscillator::speed)) = 1 + 0.05 * i;
    }
    myriad::set_coupling(e, phase_oscillator::full_sine, m.full);
    myriad::set_coupling(e, phase_oscillator::banded_cosine, m.banded);
    myriad::set_coupling(e, phase_oscillator::ring_sine, m.ring);
    myriad::set_coupling(e, phase_oscillator::all_round, m.all_round);
    e.time_domain(0, 2);
    return e;
}

template <int n>
void check_sums() {
    using W = units::phases<n>;
    const phase_matrices<n> m;
    const auto e = phases_with<n>(m);
    const auto slopes = slopes_of(e);
    Eigen::VectorXd phase(n), lag(n);
    for (int i = 0; i < n; ++i) {
        phase[i] = e.state(W::state_of(i, phase_oscillator::phase))[0];
        lag[i] = e.state(W::state_of(i, phase_oscillator::lag))[0];
    }
    const Eigen::VectorXd sine = phase.array().sin(), cosine = phase.array().cos();
    const ArrayXd full = m.full * sine, banded = m.banded * cosine, ring = m.ring * sine, all = m.all_round * cosine,
                  same = m.full * cosine;
    for (int i = 0; i < n; ++i) {
        CAPTURE(i);
        // n products of numbers up to one
        const double allowed = 8 * n * std::numeric_limits<double>::epsilon();
        CHECK(std::abs(slopes[static_cast<std::size_t>(2 * i)] -
                       (1 + 0.05 * i + cosine[i] * full[i] - sine[i] * banded[i])) <= allowed);
        CHECK(std::abs(slopes[static_cast<std::size_t>(2 * i + 1)] -
                       (phase[i] - lag[i] + ring[i] + all[i] + same[i])) <= allowed);
    }
}

/// Balls on a table where a landing stops all others.
template <int n>
myriad::ensemble<units::balls<n>> balls_with(double kick) {
    using W = units::balls<n>;
    myriad::ensemble<W> e(5);
    for (int i = 0; i < n; ++i) {
        e.state(W::state_of(i, ball::height)) = 1.0 + i;
        e.state(W::state_of(i, ball::velocity)) = 0.0;
        e.parameter(W::parameter_of(i, ball::restitution)) = 1.0;
    }
    e.shared(ball::gravity) = 1.0;
    e.shared(ball::kick) = kick;
    return e;
}
template <class W>
void solve_balls(myriad::ensemble<W>& e) {
    myriad::options o = compare::with_tolerance(1e-10);
    o.events.assign(static_cast<std::size_t>(W::n_event),
                    {.direction = myriad::direction::falling, .tolerance = 1e-12});
    myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, o);
}

}  // namespace

TEST_CASE("coupled units have the solution of the same system written as a whole") {
    compare_rings<myriad::tsitouras_5, 3>(1e-8);  // written out
    compare_rings<myriad::cash_karp, 20>(1e-8);   // a loop
}

TEST_CASE("stiff methods see the Jacobian of coupled units") {
    compare_rings<myriad::rodas_5p, 3>(1e-6);
    using namespace myriad::detail;
    CHECK(origin_of_pattern<units::ring<20>>() == pattern_origin::found);
    CHECK(n_jacobian_entry<units::ring<20>> == n_jacobian_entry<units::whole_ring<20>>);
    CHECK(n_jacobian_entry<units::ring<20>> == 20 * 5);
}

TEST_CASE("coupled units have tangents") {
    myriad::ensemble<units::ring_of_3_with_tangents> of_units(4);
    myriad::ensemble<units::whole_ring_of_3_with_tangents> whole(4);
    fill_ring<units::ring_of_3_with_tangents, double, 3>(of_units);
    fill_ring<units::whole_ring_of_3_with_tangents, double, 3>(whole);
    myriad::initial_tangents(of_units);
    myriad::initial_tangents(whole);
    myriad::solve<myriad::tsitouras_5>(tests::test_device(), of_units, compare::with_tolerance(1e-8));
    myriad::solve<myriad::tsitouras_5>(tests::test_device(), whole, compare::with_tolerance(1e-8));
    check_same(of_units, whole);
}

TEST_CASE("couplings sum what units publish, by matrices of every shape") {
    check_sums<7>();
    check_sums<19>();
}

TEST_CASE("a coupling with the matrix of another has no entries of its own") {
    using W = units::phases<7>;
    static_assert(W::n_shared == W::first_coupling + 7 * 7 + 7 * 5 + 3 + 7);
    phase_matrices<7> m;
    auto e = phases_with<7>(m);
    const auto before = slopes_of(e);
    myriad::set_coupling(e, phase_oscillator::full_cosine, Eigen::MatrixXd(2 * m.full));
    CHECK(e.shared(W::first_coupling) == 2 * m.full(0, 0));
    CHECK(slopes_of(e) != before);
}

TEST_CASE("couplings are the same in all instances of an ensemble") {
    const phase_matrices<19> m;
    auto e = phases_with<19>(m, 9);
    const auto report = myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, compare::with_tolerance(1e-8));
    REQUIRE(report.count(myriad::status::success) == 9);
    for (int c = 0; c < units::phases<19>::n_state; ++c) CHECK((e.state(c) == e.state(c)[0]).all());
}

TEST_CASE("an event of one unit acts on the others and on the system") {
    // Two balls from heights 1 and 2 under gravity 1. One lands every sqrt(2), each in turn, with the speed sqrt(2);
    // the other then stands still at height 1. The twelfth impact ends the instance.
    using W = units::balls<2>;
    auto e = balls_with<2>(1);
    e.time_domain(0, 100);
    solve_balls(e);
    for (Index i = 0; i < e.size(); ++i) {
        CAPTURE(i);
        CHECK(e.status(i) == myriad::status::stopped_by_user);
        CHECK(e.integer_accessory(ball::impacts)[i] == 12);
        CHECK(e.accessory(ball::impacts_seen)[i] == 12);
        // Errors of twelve events, 1e-12 each, and of steps, 1e-10.
        CHECK(e.accessory(W::accessory_of(0, ball::last_impact))[i] == Approx(11 * std::sqrt(2)).epsilon(1e-8));
        CHECK(e.accessory(W::accessory_of(1, ball::last_impact))[i] == Approx(12 * std::sqrt(2)).epsilon(1e-8));
        CHECK(e.accessory(W::accessory_of(0, ball::highest))[i] == Approx(1).epsilon(1e-8));
        CHECK(e.accessory(W::accessory_of(1, ball::highest))[i] == Approx(2).epsilon(1e-8));
        CHECK(e.integer_accessory(W::integer_accessory_of(0, ball::own_impacts))[i] == 6);
        CHECK(e.state(W::state_of(0, ball::height))[i] == Approx(1).epsilon(1e-7));
        CHECK(e.accessory(W::accessory_of(0, ball::steps))[i] == e.accessory(W::accessory_of(1, ball::steps))[i]);
    }
}

TEST_CASE("events of many units count for the unit whose they are") {
    // Without kicks each ball is alone: from height h it lands at sqrt(2 h), and every 2 sqrt(2 h) from then on.
    using W = units::balls<9>;
    auto e = balls_with<9>(0);
    e.time_domain(0, 6);
    solve_balls(e);
    int all = 0;
    for (int unit = 0; unit < 9; ++unit) {
        CAPTURE(unit);
        const double first = std::sqrt(2.0 * (1 + unit));
        const int impacts = static_cast<int>(std::floor((6 - first) / (2 * first))) + 1;
        all += impacts;
        CHECK(e.integer_accessory(W::integer_accessory_of(unit, ball::own_impacts))[0] == impacts);
        CHECK(e.accessory(W::accessory_of(unit, ball::last_impact))[0] ==
              Approx(first * (2 * impacts - 1)).epsilon(1e-8));
    }
    REQUIRE(all < 12);
    CHECK(e.accessory(ball::impacts_seen)[0] == all);
}

TEST_CASE("components of units lie unit by unit behind those of the system") {
    using W = units::balls<9>;
    CHECK(W::state_of(3, ball::velocity) == 7);
    CHECK(W::accessory_of(0, ball::last_impact) == 1);
    CHECK(W::accessory_of(8, ball::highest) == W::n_accessory - 1);
    CHECK(W::n_accessory == 1 + 9 * 3);
    CHECK(W::event_of(8, ball::landing) == 8);
    CHECK(units::ring<20>::shared_of(19, oscillator::forcing) == units::ring<20>::n_shared - 1);
    CHECK(units::phases<7>::first_coupling == 0);
    CHECK(units::phases<7>::n_shared == 49 + 7 * 5 + 3 + 7);
}

TEST_CASE("components of units have names with the number of the unit") {
    const auto name = [](const myriad::host::component_label& label) { return std::string(label.enumerator); };
    using W = units::balls<9>;
    CHECK(name(myriad::host::state_numbering<W>::label(W::state_of(3, ball::velocity))) == "velocity_3");
    CHECK(name(myriad::host::accessory_numbering<W>::label(ball::impacts_seen)) == "impacts_seen");
    CHECK(name(myriad::host::accessory_numbering<W>::label(W::accessory_of(8, ball::steps))) == "steps_8");
    CHECK(name(myriad::host::event_numbering<W>::label(4)) == "landing_4");
    CHECK(name(myriad::host::shared_numbering<units::phases<7>>::label(0)).empty());
    auto e = balls_with<9>(0);
    e.time_domain(0, 1);
    e.state(W::state_of(2, ball::height)) = std::nan("");
    const auto text = message_of([&] { solve_balls(e); });
    CAPTURE(text);
    CHECK(text.find("state 4 (height_2)") != text.npos);
}

TEST_CASE("matrices that do not fit a coupling are refused") {
    const phase_matrices<7> m;
    auto e = phases_with<7>(m);
    const auto text = [&](int coupling, const MatrixXd& matrix) {
        return message_of([&] { myriad::set_coupling(e, coupling, matrix); });
    };
    CHECK(text(0, MatrixXd::Zero(7, 6)) ==
          "the matrix of coupling 0 is not square, but has 7 rows and 6 columns: give it a row and a column for each "
          "of the 7 units");
    CHECK(text(0, MatrixXd::Zero(6, 6)) ==
          "the matrix of coupling 0 has 6 rows, but there are 7 units: give it a row and a column for each");
    MatrixXd broken = m.ring;
    broken(3, 4) += 1;
    CHECK(text(2, broken).starts_with("the matrix of coupling 2 is not circulant: entry (3, 4) is "));
    broken = m.all_round;
    broken(6, 0) += 1;
    CHECK(text(3, broken).starts_with("the matrix of coupling 3 is not circulant: entry (6, 0) is "));
    broken = m.banded;
    broken(0, 3) = 2;
    CHECK(text(1, broken) ==
          "entry (0, 3) of the matrix of coupling 1 is 2, outside the band of 2 diagonals on either side: declare the "
          "coupling with a larger bandwidth");
    broken = m.full;
    broken(2, 2) = std::nan("");
    CHECK(text(0, broken) == "entry (2, 2) of the matrix of coupling 0 is nan: give finite numbers");
    CHECK(text(5, m.full).starts_with("coupling 5 does not exist"));
}

TEST_CASE("the matrix of a coupling that was never set is missed") {
    using W = units::phases<19>;
    myriad::ensemble<W> e(1);
    for (int c = 0; c < W::n_state; ++c) e.state(c) = 0.0;
    for (int c = 0; c < W::n_parameter; ++c) e.parameter(c) = 0.0;
    e.time_domain(0, 1);
    const auto text = message_of([&] { myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, {}); });
    CHECK(text.find("shared parameter 0") != text.npos);
}

TEST_CASE("a NaN in one unit ends its instance alone") {
    auto e = phases_with<19>(phase_matrices<19>(), 5);
    e.parameter(units::phases<19>::parameter_of(4, phase_oscillator::speed))[2] = 1e308;
    e.state(units::phases<19>::state_of(4, phase_oscillator::phase))[2] = 1e308;
    myriad::options o = compare::with_tolerance(1e-6);
    myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, o);
    for (Index i = 0; i < e.size(); ++i) CHECK((e.status(i) == myriad::status::success) == (i != 2));
}
