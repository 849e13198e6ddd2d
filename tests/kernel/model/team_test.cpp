// SPDX-License-Identifier: MIT
// A team of threads integrates an instance as one thread does, bit for bit.
#include <cstdint>
#include <limits>

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/kernel/model/teams.hpp"

namespace {

constexpr std::int64_t instances = 6;

/// Different states, parameters and tolerances everywhere.
template <class Model>
myriad::ensemble<Model> ensemble_of() {
    myriad::ensemble<Model> e(instances);
    for (std::int64_t i = 0; i < instances; ++i) {
        for (int c = 0; c < Model::n_state; ++c) e.state(c)[i] = 1 + 0.1 * static_cast<double>((7 * c + 3 * i) % 11);
        for (int c = 0; c < Model::n_parameter; ++c)
            e.parameter(c)[i] = 2 + 0.2 * static_cast<double>((5 * c + 2 * i) % 13);
    }
    for (int c = 0; c < Model::n_shared; ++c) e.shared(c) = 0.05 * (c % 7) - 0.1;
    e.time_domain(0, 1.5);
    return e;
}
template <class Method, class Model>
auto integrate(myriad::ensemble<Model>& e, myriad::options options) {
    options.advice = myriad::advice::off;
    for (int c = 0; c < Model::n_state; ++c) options.record.states.push_back(c);
    return myriad::solve<Method>(myriad::device::cpu(1), e, options);
}

template <class Alone, class Together>
void compare(const myriad::ensemble<Alone>& alone, const myriad::ensemble<Together>& together) {
    for (std::int64_t i = 0; i < alone.size(); ++i) CHECK(alone.status(i) == together.status(i));
    for (int c = 0; c < Alone::n_state; ++c) CHECK((alone.state(c) == together.state(c)).all());
    CHECK((alone.accepted_steps() == together.accepted_steps()).all());
    CHECK((alone.rejected_steps() == together.rejected_steps()).all());
    CHECK((alone.rhs_evaluations() == together.rhs_evaluations()).all());
}
template <class Method, class Alone, class Together>
void compare(const myriad::options& options) {
    for (const auto order : {teams::order::first_thread_first, teams::order::last_thread_first}) {
        teams::order_of_threads = order;
        auto alone = ensemble_of<Alone>();
        auto together = ensemble_of<Together>();
        const auto by_one = integrate<Method>(alone, options);
        const auto by_team = integrate<Method>(together, options);
        CHECK(alone.accepted_steps().minCoeff() > 3);
        compare(alone, together);
        for (int c = 0; c < Alone::n_state; ++c) CHECK((by_one.records.state(c) == by_team.records.state(c)).all());
    }
}
/// Another one for each component, so that a wrong one shows.
myriad::options tolerances(int n) {
    myriad::options options;
    std::vector<double> relative, absolute;
    for (int c = 0; c < n; ++c) {
        relative.push_back(1e-6 / (1 + c % 3));
        absolute.push_back(1e-7 * (1 + c % 5));
    }
    options.relative_tolerance = relative;
    options.absolute_tolerance = absolute;
    return options;
}

using teams::phases;
using teams::places;
using teams::ring;

}  // namespace

TEST_CASE("a team of threads integrates units that read each other's states as one thread does") {
    compare<teams::with_memory, places<1>, places<4>>(tolerances(30));
    compare<teams::with_memory, places<1>, places<16>>(tolerances(30));
    compare<myriad::dormand_prince_8, places<1>, places<32>>(tolerances(30));
}

TEST_CASE("a team of threads takes fixed steps as one thread does") {
    compare<myriad::runge_kutta_4, places<1>, places<8>>({.step = 0.01});
}

TEST_CASE("a team of threads publishes and sums couplings as one thread does") {
    compare<myriad::cash_karp, phases<1>, phases<2>>(tolerances(38));
    compare<myriad::cash_karp, phases<1>, phases<16>>(tolerances(38));
}

TEST_CASE("a team of threads chooses the first step, and reads parameters of units, as one thread does") {
    compare<teams::careful_start, ring<1>, ring<8>>(tolerances(40));
}

TEST_CASE("a team of threads goes through phases, and carries time and step on, as one thread does") {
    myriad::options options = tolerances(30);
    options.phases = 3;
    options.phase_length = 0.4;
    options.phase_step = myriad::phase_step::carry_on;
    compare<teams::with_memory, places<1>, places<4>>(options);
}

TEST_CASE("a state that overflows in one unit ends its instance alone, in a team as in one thread") {
    auto alone = ensemble_of<places<1>>();
    auto together = ensemble_of<places<16>>();
    alone.state(17)[2] = together.state(17)[2] = 1.7e308;  // whose product with another overflows
    integrate<teams::with_memory>(alone, tolerances(30));
    integrate<teams::with_memory>(together, tolerances(30));
    for (std::int64_t i = 0; i < instances; ++i)
        CHECK(together.status(i) == (i == 2 ? myriad::status::not_finite : myriad::status::success));
    compare(alone, together);
}

TEST_CASE("a team of threads stops at the limit of steps as one thread does") {
    myriad::options options = tolerances(30);
    options.max_steps = 5;
    auto alone = ensemble_of<places<1>>();
    auto together = ensemble_of<places<4>>();
    integrate<teams::with_memory>(alone, options);
    integrate<teams::with_memory>(together, options);
    CHECK(together.status(0) == myriad::status::max_steps);
    compare(alone, together);
}
