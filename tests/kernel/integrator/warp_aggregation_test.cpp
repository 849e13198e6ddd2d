// SPDX-License-Identifier: MIT
// A thread that waits for its warp repeats a trial step: neither results nor counts may show it.
#include "tests/kernel/integrator/warp_aggregation.hpp"

#include <numbers>

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"

namespace {

template <class Model, class Method>
myriad::ensemble<Model> integrate(myriad::options options) {
    myriad::ensemble<Model> e(24);
    e.parameter(duffing::k) = Eigen::ArrayXd::LinSpaced(e.size(), 0.2, 0.3);
    e.shared(duffing::B) = 0.3;
    e.state(duffing::x) = Eigen::ArrayXd::LinSpaced(e.size(), -0.5, 0.5);
    e.state(duffing::v) = -0.1;
    for (int c = 0; c < duffing::n_accessory; ++c) e.accessory(c) = 0.0;
    e.integer_accessory(duffing::zeros) = 0;
    e.time_domain(0, 2 * std::numbers::pi);
    options.phases = 20;
    options.advice = myriad::advice::off;
    myriad::solve<Method>(myriad::device::cpu(1), e, options);
    return e;
}

template <class Method>
void compare(const myriad::options& options) {
    const auto now = integrate<warp_aggregation::at_once, Method>(options);
    const auto later = integrate<warp_aggregation::waiting, Method>(options);
    CHECK(now.located_steps().sum() > 50);
    for (const auto c : {duffing::x, duffing::v}) CHECK((now.state(c) == later.state(c)).all());
    for (std::int64_t i = 0; i < now.size(); ++i) CHECK(now.status(i) == later.status(i));
    for (int c = 0; c < duffing::n_accessory; ++c) CHECK((now.accessory(c) == later.accessory(c)).all());
    CHECK((now.integer_accessory(duffing::zeros) == later.integer_accessory(duffing::zeros)).all());
    CHECK((now.accepted_steps() == later.accepted_steps()).all());
    CHECK((now.located_steps() == later.located_steps()).all());
    CHECK((now.rhs_evaluations() == later.rhs_evaluations()).all());
}

}  // namespace

TEST_CASE("a thread that waits for its warp before its events changes no bit and no count, with adaptive steps") {
    compare<myriad::cash_karp>({.relative_tolerance = 1e-9, .absolute_tolerance = 1e-9});
}

TEST_CASE("a thread that waits for its warp before its events changes no bit and no count, with fixed steps") {
    compare<myriad::runge_kutta_4>({.step = 0.05});
}

TEST_CASE("a thread that waits for its warp reaches the limit of steps where one that does not wait reaches it") {
    compare<myriad::cash_karp>({.relative_tolerance = 1e-9, .absolute_tolerance = 1e-9, .max_steps = 95});
}
