// SPDX-License-Identifier: MIT
// Gradients by the adjoint of models written in C++.
#include <cmath>
#include <limits>
#include <vector>

#include <myriad/adjoint.hpp>
#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/host/solve/adjoint_models.hpp"

using namespace adjoints;
using explicit_method = myriad::dense<myriad::dormand_prince_5>;
using stiff_method = myriad::dense<myriad::rodas_5p>;

namespace {

/// Half the sum of squares of all states at all times.
const auto half_squares = [](std::int64_t, const auto& y, auto& by_y) { by_y = y; };

myriad::ensemble<network> networks(std::int64_t size) {
    myriad::ensemble<network> e(size);
    for (int c = 0; c < network::n_state; ++c)
        e.state(c) = Eigen::ArrayXd::LinSpaced(size, 0.2 + 0.3 * c, 1.1 - 0.2 * c);
    for (int i = 0; i < network::n_parameter; ++i)
        e.parameter(i) = Eigen::ArrayXd::LinSpaced(size, 0.3 + 0.1 * i, 1.4 - 0.05 * i);
    e.time_domain(0.0, 3.0);
    return e;
}
myriad::ensemble<kinetics> reactions(std::int64_t size) {
    myriad::ensemble<kinetics> e(size);
    e.state(kinetics::a) = 1.0;
    e.state(kinetics::b) = 0.0;
    e.state(kinetics::c) = 0.0;
    e.parameter(kinetics::slow) = Eigen::ArrayXd::LinSpaced(size, 0.02, 0.06);
    e.parameter(kinetics::fast) = 3e7;
    e.parameter(kinetics::middle) = 1e4;
    e.time_domain(0.0, 100.0);
    return e;
}

/// Compares the adjoint's gradient of half the squares with that by forward sensitivities, whose steps are the same.
template <class Method, class Model, class Varied>
void compare_with_sensitivities(myriad::ensemble<Model> e, const std::vector<double>& times, double tolerance) {
    constexpr int n = Model::n_state, m = Model::n_parameter;
    myriad::options o;
    o.relative_tolerance = o.absolute_tolerance = 1e-7;
    const auto found = myriad::adjoint<Method>(e, times, half_squares, o);

    myriad::ensemble<Varied> varied(e.size());
    for (int c = 0; c < n; ++c) varied.state(c) = e.state(c);
    for (int i = 0; i < m; ++i) varied.parameter(i) = e.parameter(i);
    varied.time_domain(e.t_begin_of(0), e.t_end_of(0));
    myriad::initial_sensitivities(varied);
    o.samples.times = times;
    o.samples.capacity = static_cast<std::int64_t>(times.size());
    for (int c = 0; c < n * (1 + n + m); ++c) o.samples.states.push_back(c);
    myriad::solve<Method>(myriad::device::cpu(), varied, o);
    for (std::int64_t i = 0; i < e.size(); ++i) {
        CHECK(found.statuses[static_cast<std::size_t>(i)] == myriad::status::success);
        for (int d = 0; d < n + m; ++d) {
            double expected = 0, size = 0;
            for (int k = 0; k < static_cast<int>(times.size()); ++k)
                for (int c = 0; c < n; ++c) {
                    const double term = varied.samples().state(c)(i, k) *
                                        varied.samples().state(static_cast<int>(Varied::sensitivity(c, d)))(i, k);
                    expected += term;
                    size += std::abs(term);
                }
            const double got = d < n ? found.by_state(i, d) : found.by_parameter(i, d - n);
            INFO("instance " << i << ", component " << d << ": " << got << " and " << expected);
            CHECK(std::abs(got - expected) <= tolerance * size);
        }
    }
}

}  // namespace

TEST_CASE("the gradient by an adjoint is that of the closed solution", "[adjoint]") {
    myriad::ensemble<decay> e(7);
    e.state(decay::x) = Eigen::ArrayXd::LinSpaced(7, 1.0, 2.0);
    e.state(decay::y) = 0.0;
    e.parameter(decay::k) = Eigen::ArrayXd::LinSpaced(7, 0.5, 1.5);
    e.shared(decay::b) = 0.0;
    e.time_domain(0.0, 2.0);
    myriad::options o;
    o.relative_tolerance = o.absolute_tolerance = 1e-10;
    // x(t) = x0 exp(-k t)
    // snippet: adjoint
    const auto loss = [](std::int64_t, const auto& /*y*/, auto& by_y) {  // x(0.5) + 3 x(2)
        by_y(decay::x, 0) = 1.0;
        by_y(decay::x, 1) = 3.0;
    };
    const myriad::adjoint_gradients found = myriad::adjoint<explicit_method>(e, {0.5, 2.0}, loss, o);
    // found.by_state(i, decay::x) and found.by_parameter(i, decay::k) of instance i
    // end of snippet
    for (std::int64_t i = 0; i < 7; ++i) {
        const double x0 = e.state(decay::x)(i), k = e.parameter(decay::k)(i);
        const double early = std::exp(-0.5 * k), late = 3 * std::exp(-2 * k);
        CHECK(found.by_state(i, 0) == Approx(early + late).epsilon(1e-8));
        CHECK(found.by_state(i, 1) == 0.0);
        CHECK(found.by_parameter(i, 0) == Approx(-x0 * (0.5 * early + 2 * late)).epsilon(1e-8));
    }
    CHECK(e.state(decay::x)(0) == 1.0);  // the ensemble is left as it was
    CHECK(e.status(0) == myriad::status::not_started);
}

TEST_CASE("an adjoint without times is of the states at the end, also backwards and with own time domains",
          "[adjoint]") {
    myriad::ensemble<decay> e(3);
    e.state(decay::x) = 1.0;
    e.state(decay::y) = 0.0;
    e.parameter(decay::k) = 0.7;
    e.shared(decay::b) = 0.0;
    e.t_begin() = 1.0;
    e.t_end() << 2.0, 0.0, -1.0;
    const auto found =
        myriad::adjoint<explicit_method>(e, {}, [](std::int64_t, const auto&, auto& by_y) { by_y(0, 0) = 1.0; });
    for (std::int64_t i = 0; i < 3; ++i)
        CHECK(found.by_state(i, 0) == Approx(std::exp(-0.7 * (e.t_end()(i) - 1.0))).epsilon(1e-6));
}

TEST_CASE("an adjoint has the gradient of forward sensitivities", "[adjoint]") {
    SECTION("explicit, with samples inside steps") {
        compare_with_sensitivities<explicit_method, network, network_by_all>(networks(21), {0.0, 0.3, 1.1, 1.2, 3.0},
                                                                             1e-11);
    }
    SECTION("stiff") {  // the condition numbers of its matrices are about 1e8
        compare_with_sensitivities<stiff_method, kinetics, kinetics_by_all>(reactions(11), {0.1, 5.0, 100.0}, 3e-8);
    }
}

TEST_CASE("an infinite slope that nothing depends on leaves no trace in an adjoint", "[adjoint]") {
    myriad::ensemble<guarded> e(1);
    e.state(guarded::x) = -1.0;
    e.parameter(guarded::k) = 0.5;
    e.time_domain(0.0, 1.0);
    const auto found =
        myriad::adjoint<explicit_method>(e, {}, [](std::int64_t, const auto&, auto& by_y) { by_y(0, 0) = 1.0; });
    CHECK(found.by_state(0, 0) == Approx(std::exp(-0.5)).epsilon(1e-6));
}

TEST_CASE("the place of an instance changes no bit of its gradient", "[adjoint]") {
    auto e = networks(150), turned = networks(150);
    for (int c = 0; c < network::n_state; ++c) turned.state(c) = e.state(c).reverse().eval();
    for (int i = 0; i < network::n_parameter; ++i) turned.parameter(i) = e.parameter(i).reverse().eval();
    const auto found = myriad::adjoint<explicit_method>(e, {1.0, 3.0}, half_squares);
    const auto other = myriad::adjoint<explicit_method>(turned, {1.0, 3.0}, half_squares);
    CHECK((found.by_state == other.by_state.colwise().reverse()).all());
    CHECK((found.by_parameter == other.by_parameter.colwise().reverse()).all());
}

TEST_CASE("an instance with many steps gets room for them, and one that fails has NaN alone", "[adjoint]") {
    myriad::ensemble<decay> e(3);
    e.state(decay::x) = 1.0;
    e.state(decay::y) = 0.0;
    e.parameter(decay::k) << 0.5, -1e4, 0.5;  // the second one grows beyond all numbers
    e.shared(decay::b) = 0.0;
    e.time_domain(0.0, 3.0);
    myriad::options o;
    o.maximum_step = 0.005;
    const auto found = myriad::adjoint<explicit_method>(
        e, {},
        [](std::int64_t i, const auto&, auto& by_y) {
            CHECK(i != 1);
            by_y(0, 0) = 1.0;
        },
        o);
    CHECK(myriad::is_failure(found.statuses[1]));
    CHECK(std::isnan(found.by_state(1, 0)));
    CHECK(std::isnan(found.by_parameter(1, 0)));
    for (const std::int64_t i : {0, 2}) CHECK(found.by_state(i, 0) == Approx(std::exp(-1.5)).epsilon(1e-7));
}

TEST_CASE("a call of an adjoint that cannot be is refused with what to do", "[adjoint]") {
    const auto refused = [](auto&& change, const std::vector<double>& times, const char* words) {
        myriad::ensemble<decay> e(2);
        e.state(decay::x) = 1.0;
        e.state(decay::y) = 0.0;
        e.parameter(decay::k) = 1.0;
        e.shared(decay::b) = 0.0;
        e.time_domain(0.0, 1.0);
        myriad::options o;
        change(e, o);
        CHECK_THROWS_WITH(myriad::adjoint<explicit_method>(e, times, half_squares, o), Catch::Contains(words));
    };
    refused([](auto&, auto& o) { o.phases = 2; }, {}, "an adjoint is of one phase");
    refused([](auto&, auto& o) { o.samples.states = {0}; }, {}, "an adjoint keeps samples of its own");
    refused([](auto& e, auto&) { e.t_end()(1) = 2.0; }, {0.5}, "time domains of their own");
    refused([](auto&, auto&) {}, {0.5, 0.4}, "does not follow the one before");
    refused([](auto&, auto&) {}, {1.5}, "is not in the time domain");
    refused([](auto& e, auto&) { e.parameter(decay::k)(1) = std::numeric_limits<double>::quiet_NaN(); }, {},
            "instance 1");
    refused([](auto& e, auto&) { myriad::solve<explicit_method>(myriad::device::cpu(), e); }, {},
            "has been integrated");

    auto e = networks(1);
    using not_there = myriad::dense<myriad::runge_kutta_4>;
    myriad::options o;
    o.step = 0.01;
    CHECK_THROWS_WITH(myriad::adjoint<not_there>(e, {}, half_squares, o),
                      Catch::Contains("add MYRIAD_INSTANTIATE_ADJOINT(model, method)"));
}
