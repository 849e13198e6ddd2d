// SPDX-License-Identifier: MIT
// Tangents by stiff methods, whose matrix has second derivatives of rhs: against other methods, differences of
// trajectories and closed forms, and at what cost in steps.
#include <cmath>
#include <cstdint>

#include <Eigen/Dense>
#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/kernel/model/stiff_tangents.hpp"
#include "tests/kernel/model/tangent_vectors.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/device.hpp"

namespace {

using compare::with_tolerance;
using namespace stiff_tangents;
using myriad::ensemble;
using myriad::rodas_5p;
using myriad::rosenbrock_23;
using myriad::tsitouras_5;
using tangents::tangents_of;

template <class Model>
void fill_ring(ensemble<Model>& e) {
    for (int c = 0; c < 8; ++c) e.state(c) = Eigen::ArrayXd::LinSpaced(e.size(), 1 + c / 3.0, 2 - c / 7.0);
    e.parameter(ring::mu) = 20;
    e.time_domain(0, 1);
}
/// The derivative of the flow along the given direction, by a central difference.
template <class Model, class Fill>
Eigen::VectorXd difference(Fill fill, const Eigen::VectorXd& direction) {
    constexpr double h = 1e-4;
    Eigen::VectorXd ends[2];
    for (const int sign : {1, -1}) {
        ensemble<Model> e(1);
        fill(e);
        for (int c = 0; c < Model::n_state; ++c) e.state(c)[0] += sign * h * direction[c];
        myriad::solve<rodas_5p>(tests::test_device(1), e, with_tolerance(1e-12));
        Eigen::VectorXd& y = ends[sign < 0];
        y.resize(Model::n_state);
        for (int c = 0; c < Model::n_state; ++c) y[c] = e.state(c)[0];
    }
    return (ends[0] - ends[1]) / (2 * h);
}

/// The largest error of the first tangent after a phase, relative to its length.
template <class Method, class W, class Fill>
double error_of_tangent(Fill fill, double tolerance) {
    ensemble<W> e(1);
    fill(e);
    myriad::initial_tangents(e);
    const Eigen::VectorXd start = tangents_of(e, 0).col(0);
    CHECK(myriad::solve<Method>(tests::test_device(1), e, with_tolerance(tolerance)).failed() == 0);
    const Eigen::VectorXd expected = difference<typename W::original>(fill, start);
    return (tangents::first_tangent(e, 0) - expected).norm() / expected.norm();
}

}  // namespace

TEST_CASE("the tangent of a stiff network is a difference of trajectories") {
    // differences of 1e-4 with third derivatives of 10 or so, and steps with errors of the tolerance
    CHECK(error_of_tangent<rodas_5p, ring_with_two>([](auto& e) { fill_ring(e); }, 1e-9) <= 1e-5);
}

TEST_CASE("stiff and explicit methods find the same tangents where rhs depends on time") {
    const auto after = [](auto solve, double tolerance) {
        ensemble<forced_with_one> e(7);
        e.state(forced::x).setLinSpaced(-1, 1);
        e.state(forced::v) = 0.3;
        e.parameter(forced::k).setLinSpaced(0.5, 3);
        myriad::initial_tangents(e);
        e.time_domain(0.5, 2);
        CHECK(solve(e, with_tolerance(tolerance)).failed() == 0);
        Eigen::MatrixXd all(7, 3);
        for (Eigen::Index i = 0; i < 7; ++i) {
            all.block(i, 0, 1, 2) = tangents::first_tangent(e, i).transpose();
            all(i, 2) = e.state(forced::v)[i];
        }
        return all;
    };
    const Eigen::MatrixXd expected =
        after([](auto& e, const auto& o) { return myriad::solve<tsitouras_5>(tests::test_device(1), e, o); }, 1e-12);
    const auto by_rodas =
        after([](auto& e, const auto& o) { return myriad::solve<rodas_5p>(tests::test_device(1), e, o); }, 1e-9);
    const auto by_rosenbrock =
        after([](auto& e, const auto& o) { return myriad::solve<rosenbrock_23>(tests::test_device(1), e, o); }, 1e-7);
    CHECK((by_rodas - expected).cwiseAbs().maxCoeff() <= 1e-6);
    CHECK((by_rosenbrock - expected).cwiseAbs().maxCoeff() <= 1e-4);
}

TEST_CASE("the exponent of a stiff decay is its rate") {
    using W = stiff::prothero_robinson_with_tangent;
    ensemble<W> e(3);
    e.state(stiff::prothero_robinson::y0) = 0.0;
    e.parameter(stiff::prothero_robinson::rate) = Eigen::Array3d(1e2, 1e4, 1e6);
    myriad::initial_tangents(e);
    e.t_begin() = 0.0;
    e.t_end() = Eigen::Array3d(1e-2, 1e-4, 1e-6);  // over which the tangent shrinks by e
    const auto report = myriad::solve<rodas_5p>(tests::test_device(1), e,
                                                {.phases = 10, .relative_tolerance = 1e-9, .absolute_tolerance = 1e-9});
    CHECK(report.failed() == 0);
    for (Eigen::Index i = 0; i < 3; ++i) CHECK(std::abs(e.accessory(W::growth())[i] + 10) <= 1e-6);
}

TEST_CASE("tangents left out of the error test cost no steps, and in it not twice as many") {
    constexpr double tolerance = 1e-7;
    ensemble<ring> plain(8);
    fill_ring(plain);
    ensemble<ring_with_two> with(8);
    fill_ring(with);
    myriad::initial_tangents(with);
    const auto own = myriad::solve<rodas_5p>(tests::test_device(1), plain, with_tolerance(tolerance));
    const auto all = myriad::solve<rodas_5p>(tests::test_device(1), with, with_tolerance(tolerance));
    with.restart();
    fill_ring(with);
    myriad::initial_tangents(with);
    myriad::options left_out = with_tolerance(tolerance);
    left_out.relative_tolerance = myriad::without_tangents<ring_with_two>(left_out.relative_tolerance);
    left_out.absolute_tolerance = myriad::without_tangents<ring_with_two>(left_out.absolute_tolerance);
    const auto without = myriad::solve<rodas_5p>(tests::test_device(1), with, left_out);
    INFO(own.accepted_steps << " steps without tangents, " << all.accepted_steps << " with them in the error test, "
                            << without.accepted_steps << " with them out of it");
    CHECK(std::abs(without.accepted_steps - own.accepted_steps) <= own.accepted_steps / 100);
    CHECK(all.accepted_steps <= 2 * own.accepted_steps);
}

TEST_CASE("the matrix of a model with tangents has the pattern of the model's own, block by block") {
    ensemble<ring_with_two> e(1);
    fill_ring(e);
    myriad::initial_tangents(e);
    const auto report = myriad::solve<rodas_5p>(tests::test_device(1), e, with_tolerance(1e-5));
    CHECK(report.matrix.states == 24);
    CHECK(report.matrix.jacobian_entries == 20 * (1 + 2 * 2));
    CHECK(report.matrix.factor_entries < 24 * 24 / 2);
    CHECK(report.matrix.jacobian_evaluations <= 10);  // the blocks of several tangents share theirs
}

TEST_CASE("stiff methods take tangents through impacts as explicit ones do") {
    using namespace tangents;
    using W = table_spectrum;
    myriad::options o = with_tolerance(1e-10);
    o.events = {{.direction = myriad::direction::falling, .tolerance = 1e-11}, {.tolerance = 1e-11}};
    const auto fall = [&](auto solve) {
        ensemble<W> e(5);
        e.parameter(table::r).setLinSpaced(0.85, 1.0);
        e.shared(table::amplitude) = 0.1;
        e.shared(table::drag) = 0.05;
        e.shared_integer(table::bounces_allowed) = 100;
        e.state(table::x) = Eigen::ArrayXd::LinSpaced(5, 1, 1.3);
        e.state(table::v) = 0.1;
        myriad::initial_tangents(e);
        e.time_domain(0, 4);
        CHECK(solve(e).failed() == 0);
        for (Eigen::Index i = 0; i < 5; ++i) CHECK(e.integer_accessory(table::bounces)[i] >= 1);
        Eigen::ArrayXXd growth(5, 2);
        growth << e.accessory(W::growth(0)), e.accessory(W::growth(1));
        return growth;
    };
    const auto expected = fall([&](auto& e) { return myriad::solve<tsitouras_5>(tests::test_device(1), e, o); });
    const auto found = fall([&](auto& e) { return myriad::solve<rodas_5p>(tests::test_device(1), e, o); });
    CHECK((found - expected).abs().maxCoeff() <= 1e-6);
}
