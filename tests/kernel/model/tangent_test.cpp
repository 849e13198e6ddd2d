// SPDX-License-Identifier: MIT
// Tangents of smooth flows agree with closed forms, exponents with known ones, and the model itself is unaffected.
#include "myriad/kernel/model/tangent.hpp"

#include <cmath>
#include <complex>
#include <limits>

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

template <class W, class R>
double departure_from_orthonormal(const myriad::ensemble<W, R>& e) {
    double most = 0;
    for (Index i = 0; i < e.size(); ++i) {
        const auto q = tangents_of(e, i);
        const Eigen::MatrixXd gram = q.transpose() * q;
        const double off = (gram - Eigen::MatrixXd::Identity(W::n_vectors, W::n_vectors)).cwiseAbs().maxCoeff();
        most = off <= most ? most : off;  // NaN too
    }
    return most;
}

template <class R>
myriad::ensemble<lorenz_spectrum, R> lorenz_sweep(Index size, R phase_length) {
    myriad::ensemble<lorenz_spectrum, R> e(size);
    e.parameter(lorenz::rho) = R(28);
    e.state(lorenz::x).setLinSpaced(R(-10), R(10));
    e.state(lorenz::y) = R(1);
    e.state(lorenz::z) = R(20);
    myriad::initial_tangents(e);
    e.time_domain(0, phase_length);
    return e;
}

myriad::ensemble<spiral_spectrum> spirals(double t_end) {
    using W = spiral_spectrum;
    myriad::ensemble<W> e(40);
    e.parameter(spiral::growth).setLinSpaced(-0.5, 0.5);
    e.parameter(spiral::frequency) = 2;
    e.parameter(spiral::decay).setLinSpaced(-1, 0.8);
    e.parameter(spiral::coupling) = 1.5;
    for (int c = 0; c < spiral::n_state; ++c) e.state(c) = 1;
    myriad::initial_tangents(e);
    e.time_domain(0, t_end);
    return e;
}

/// The solution of the spiral's equations, linear in where it starts: z is driven by the real part of a complex
/// exponential.
Eigen::Vector3d spiral_flow(const myriad::ensemble<spiral_spectrum>& e, Index i, double t,
                            const Eigen::Vector3d& start) {
    const std::complex<double> eigenvalue(e.parameter(spiral::growth)[i], e.parameter(spiral::frequency)[i]);
    const double decay = e.parameter(spiral::decay)[i];
    const std::complex<double> z0(start[0], start[1]), z = z0 * std::exp(eigenvalue * t);
    const auto driven = z0 * (std::exp(eigenvalue * t) - std::exp(decay * t)) / (eigenvalue - decay);
    return {z.real(), z.imag(), start[2] * std::exp(decay * t) + e.parameter(spiral::coupling)[i] * driven.real()};
}

/// Mean over the instances and its standard error, from their spread.
struct estimate {
    double mean, error;
    explicit estimate(const ArrayXd& values)
        : mean(values.mean()),
          error(std::sqrt((values - mean).square().sum() / static_cast<double>((values.size() - 1) * values.size()))) {}
};

}  // namespace

TEST_CASE("the initial tangents are orthonormal, and no component of them is zero") {
    auto e = lorenz_sweep<double>(3, 1);
    CHECK(departure_from_orthonormal(e) <= 4 * std::numeric_limits<double>::epsilon());
    for (Index i = 0; i < e.size(); ++i) CHECK(tangents_of(e, i).cwiseAbs().minCoeff() > 0.01);
}

TEST_CASE("tangents of a linear flow are its solutions, forwards and backwards") {
    const double t = GENERATE(3.0, -3.0);
    CAPTURE(t);
    auto e = spirals(t);
    const Eigen::Vector3d start = tangents_of(e, 0).col(0);
    const auto report = myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, with_tolerance(1e-12));
    REQUIRE(report.count(myriad::status::success) == e.size());
    for (Index i = 0; i < e.size(); ++i) {
        const Eigen::Vector3d exact = spiral_flow(e, i, t, start);
        // At most 2000 steps with an error of 1e-12, which grows like the solutions: by e^3 at most.
        CAPTURE(i, e.accepted_steps()[i]);
        CHECK(e.accepted_steps()[i] < 2000);
        CHECK((first_tangent(e, i) - exact).cwiseAbs().maxCoeff() <= 4e-8);
    }
    // The exponents of the flow sum to its trace, in either direction of time.
    const ArrayXd trace = 2 * e.parameter(spiral::growth) + e.parameter(spiral::decay);
    CHECK((myriad::exponents(e).rowwise().sum() - trace).abs().maxCoeff() <= 4e-8);
}

TEST_CASE("with fixed steps the tangent is the derivative of the method's own map") {
    // For a linear flow the map of Runge-Kutta 4 is linear: the first four terms of the exponential series, per step.
    auto e = spirals(1);
    e.parameter(spiral::coupling) = 0;
    e.state(spiral_spectrum::tangent(spiral::x)) = 1;
    e.state(spiral_spectrum::tangent(spiral::y)) = 0;
    e.state(spiral_spectrum::tangent(spiral::z)) = 0;
    e.state(spiral_spectrum::tangent(spiral::x, 1)) = 0;
    myriad::solve<myriad::runge_kutta_4>(tests::test_device(), e, {.step = 0.125});
    for (Index i = 0; i < e.size(); ++i) {
        const std::complex<double> z = 0.125 * std::complex<double>(e.parameter(spiral::growth)[i], 2);
        const double growth = 8 * std::log(std::abs(1.0 + z + z * z / 2.0 + z * z * z / 6.0 + z * z * z * z / 24.0));
        CHECK(std::abs(e.accessory(spiral_spectrum::growth(0))[i] - growth) <= 1e-14);  // some dozen roundings
    }
}

TEST_CASE("exponents of a linear flow are the real parts of its eigenvalues, and a rotation has zero") {
    auto e = spirals(0.5);
    e.parameter(spiral::growth) = ArrayXd::LinSpaced(e.size(), -0.5, 0);  // the last one rotates
    e.parameter(spiral::decay) = -1;
    const int transient = 100, phases = 1100;
    e.shared_integer(spiral_spectrum::transient_phases) = transient;
    myriad::options o = with_tolerance(1e-10);
    o.phases = phases;
    myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, o);
    CHECK((e.accessory(spiral_spectrum::time_summed) == 0.5 * (phases - transient)).all());  // exact in binary
    const Eigen::ArrayXXd found = myriad::exponents(e);
    for (int i = 0; i < spiral_spectrum::n_vectors; ++i)
        CHECK((e.accessory(spiral_spectrum::exponent(i)) == found.col(i)).all());
    const ArrayXd growth = e.parameter(spiral::growth);
    // By then the tangents of an instance are in their planes to e^(-0.5 * 50), and rotate there, with lengths that
    // vary by a factor of less than 4 (the coupling tilts the plane): over a time of 500 that makes ln 4 / 500.
    CHECK((found.col(0) - growth).abs().maxCoeff() <= 2.8e-3);
    CHECK((found.col(1) - growth).abs().maxCoeff() <= 2.8e-3);
    CHECK((found.col(2) + 1).abs().maxCoeff() <= 2.8e-3);
    // Their sum is the trace: steps of 0.02 or more with errors of 1e-10, in each of three tangents.
    CHECK((found.rowwise().sum() - (2 * growth - 1)).abs().maxCoeff() <= 3e-8);
}

TEST_CASE("exponents of Lorenz' equations are those known, and sum up to the divergence") {
    const int phases = 2000;
    auto e = lorenz_sweep<double>(512, 0.25);
    e.shared_integer(lorenz_spectrum::transient_phases) = 200;
    myriad::options o = with_tolerance(1e-7);
    o.phases = phases;
    const auto report = myriad::solve<myriad::tsitouras_5>(tests::test_device(2), e, o);
    REQUIRE(report.count(myriad::status::success) == e.size());
    CHECK(report.notes.empty());  // (l1 - l3) T is 3.9: harmless
    const Eigen::ArrayXXd found = myriad::exponents(e);
    const estimate largest(found.col(0)), middle(found.col(1));
    CAPTURE(largest.mean, largest.error, middle.mean, middle.error);
    CHECK(largest.error <= 4e-4);  // else the next lines prove nothing
    CHECK(std::abs(largest.mean - 0.9055) <= 3e-4 + 3 * largest.error);
    CHECK(std::abs(middle.mean) <= 3 * middle.error + 1e-5);
    // The divergence is the same everywhere. 100 steps per unit of time err by 1e-7 in each of three tangents.
    CHECK((found.rowwise().sum() + 41.0 / 3).abs().maxCoeff() <= 3e-5);
    CHECK(departure_from_orthonormal(e) <= 8 * std::numeric_limits<double>::epsilon());
}

TEST_CASE("the largest exponent of Roessler's equations is the one known") {
    using W = myriad::with_tangents<roessler>;
    myriad::ensemble<W> e(512);
    e.state(roessler::x).setLinSpaced(1, 5);
    e.state(roessler::y) = 0;
    e.state(roessler::z) = 0;
    myriad::initial_tangents(e);
    e.time_domain(0, 10);
    e.shared_integer(W::transient_phases) = 20;
    myriad::options o = with_tolerance(1e-7);
    o.phases = 520;
    const auto report = myriad::solve<myriad::tsitouras_5>(tests::test_device(2), e, o);
    REQUIRE(report.count(myriad::status::success) == e.size());
    const estimate largest(myriad::exponents(e).col(0));
    CAPTURE(largest.mean, largest.error);
    CHECK(largest.error <= 1.2e-4);
    CHECK(std::abs(largest.mean - 0.0714) <= 2e-4 + 3 * largest.error);
}

namespace {

/// The mean smallest exponent of 128 solutions over 100 units of time, and the report's note about phases.
std::pair<double, std::string> smallest_of_strong_roessler(double phase, double tolerance) {
    using W = strong_roessler_spectrum;
    myriad::ensemble<W> e(128);
    e.state(roessler::x).setLinSpaced(1, 5);
    e.state(roessler::y) = 0;
    e.state(roessler::z) = 0;
    myriad::initial_tangents(e);
    e.time_domain(0, phase);
    const auto transient = static_cast<int>(50 / phase);
    e.shared_integer(W::transient_phases) = transient;
    myriad::options o = with_tolerance(tolerance);
    o.phases = transient + static_cast<int>(100 / phase);
    const auto report = myriad::solve<myriad::tsitouras_5>(tests::test_device(2), e, o);
    CHECK(report.failed() == 0);
    std::string said;
    for (const std::string note : report.notes)
        if (note.find("smallest exponent") != std::string::npos) said = note;
    return {myriad::exponents(e).col(2).mean(), said};
}

}  // namespace

TEST_CASE("where tolerance and phase length spoil the smallest exponent, the report says that they may") {
    const auto [right, nothing] = smallest_of_strong_roessler(1, 1e-10);
    CHECK(nothing == "");
    const auto [spoilt, said] = smallest_of_strong_roessler(1, 1e-6);  // (l1 - l3) T is 9.8
    CHECK(spoilt - right > 0.3);
    CHECK(said.find("phases may be too long for the smallest exponent in 128 of 128 instances looked at") == 0);
    CHECK(smallest_of_strong_roessler(1, 1e-8).second != "");
    // Shorter phases cure it.
    const auto [healed, silence] = smallest_of_strong_roessler(0.25, 1e-6);
    CHECK(std::abs(healed - right) < 0.05);  // five standard errors of 128 solutions over 100
    CHECK(silence == "");
}

TEST_CASE("on a limit cycle one exponent is zero and the other the mean divergence") {
    // The cycle in long double: Runge-Kutta 4 with steps of 1e-3 errs by less than 1e-11.
    using cycle = Eigen::Array<long double, 3, 1>;  // x, v and the integral of the divergence
    const auto slope = [](const cycle& y) {
        const auto f = van_der_pol::rhs<long double>(0, {y[0], y[1]}, 0);
        return cycle(f[0], f[1], 1 - y[0] * y[0]);
    };
    const auto step = [&](const cycle& y, long double h) -> cycle {
        const cycle a = slope(y), b = slope(y + h / 2 * a), c = slope(y + h / 2 * b), d = slope(y + h * c);
        return y + h / 6 * (a + 2 * b + 2 * c + d);
    };
    cycle y(2, 0, 0);
    long double t = 0, t_maximum = 0, divergence = 0, period = 0;
    for (int maxima = 0; maxima < 8;) {  // each period brings the cycle closer by a factor of 1000
        const long double h = 1e-3L;
        if (y[1] > 0 && step(y, h)[1] <= 0) {
            long double low = 0, high = h;
            for (int i = 0; i < 64; ++i) {
                const long double middle = (low + high) / 2;
                (step(y, middle)[1] > 0 ? low : high) = middle;
            }
            period = t + high - t_maximum;
            t_maximum = t + high;
            const long double integral = step(y, high)[2];
            y[2] -= integral;
            divergence = integral / period;
            ++maxima;
        }
        y = step(y, h);
        t += h;
    }
    CHECK(std::abs(static_cast<double>(period) - 6.66328685932313) <= 1e-10);  // all digits known

    using W = van_der_pol_spectrum;
    myriad::ensemble<W> e(16);
    e.state(van_der_pol::x).setLinSpaced(-2, 2);
    e.state(van_der_pol::v) = 1;
    myriad::initial_tangents(e);
    e.time_domain(0, static_cast<double>(period));
    e.shared_integer(W::transient_phases) = 10;
    myriad::options o = with_tolerance(1e-11);
    o.phases = 20;
    myriad::solve<myriad::cash_karp>(tests::test_device(), e, o);
    const Eigen::ArrayXXd found = myriad::exponents(e);
    // At most 1000 steps per period with errors of 1e-11, by which the cycle is not closed either.
    CHECK(e.accepted_steps().maxCoeff() <= 20 * 1000);
    CHECK(found.col(0).abs().maxCoeff() <= 1e-8);
    CHECK((found.col(1) - static_cast<double>(divergence)).abs().maxCoeff() <= 1e-8);
}

TEST_CASE("left out of the error test, tangents do not change a bit of the model") {
    auto e = lorenz_sweep<double>(20, 0.7);
    myriad::ensemble<lorenz> alone(e.size());
    alone.parameter(lorenz::rho) = 28;
    for (int c = 0; c < lorenz::n_state; ++c) alone.state(c) = e.state(c);
    alone.time_domain(0, 0.7);
    myriad::options o = with_tolerance(1e-9);
    o.phases = 3;
    myriad::solve<myriad::tsitouras_5>(tests::test_device(), alone, o);
    o.relative_tolerance = o.absolute_tolerance = myriad::without_tangents<lorenz_spectrum>(1e-9);
    myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, o);
    for (int c = 0; c < lorenz::n_state; ++c) {
        if (tests::tests_cpu()) {
            CHECK(same_bits_everywhere(e.state(c), alone.state(c)));
        } else {  // its compiler may fuse different operations: roundings grow by e^(0.9 * 2.1) and a little more
            CHECK((e.state(c) - alone.state(c)).abs().maxCoeff() <= 1e-10);
        }
    }
    if (tests::tests_cpu()) CHECK(same_bits_everywhere(e.accepted_steps(), alone.accepted_steps()));
}

TEST_CASE("phases in one call and in many give the same bits, sums included") {
    auto once = lorenz_sweep<double>(9, 0.3), often = lorenz_sweep<double>(9, 0.3);
    myriad::options o = with_tolerance(1e-8);
    o.phase_step = myriad::phase_step::carry_on;
    for (int k = 0; k < 5; ++k) myriad::solve<myriad::tsitouras_5>(tests::test_device(), often, o);
    o.phases = 5;
    myriad::solve<myriad::tsitouras_5>(tests::test_device(), once, o);
    CHECK(compare::difference(once, often).empty());
}

TEST_CASE("exponents in single precision sum up to the divergence too") {
    auto e = lorenz_sweep<float>(64, 0.25f);
    myriad::options o = with_tolerance(1e-5);
    o.phases = 100;
    const auto report = myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, o);
    REQUIRE(report.count(myriad::status::success) == e.size());
    const Eigen::ArrayXXf found = myriad::exponents(e);
    // 50 steps per unit of time err by 1e-5 in each of three tangents, 400 roundings of a sum of 300 by 1.5e-5 over 25.
    CHECK((found.rowwise().sum() + 41.0f / 3).abs().maxCoeff() <= 2e-3f);
    CHECK(departure_from_orthonormal(e) <= 8 * static_cast<double>(std::numeric_limits<float>::epsilon()));
}

TEST_CASE("tangents that nobody set are refused by name") {
    auto e = lorenz_sweep<double>(2, 1);
    e.state(lorenz_spectrum::tangent(lorenz::y)) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, with_tolerance(1e-8)),
                      Catch::Matchers::Contains("state 4 is NaN"));
}
