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
    for (int c = 0; c < Model::n_accessory; ++c) e.accessory(c) = 100 + c;
    for (int c = 0; c < Model::n_integer_accessory; ++c) e.integer_accessory(c) = 200 + c;
    e.time_domain(0, 1.5);
    return e;
}
template <class Method, class Model>
auto integrate(myriad::ensemble<Model>& e, myriad::options options) {
    options.advice = myriad::advice::off;
    for (int c = 0; c < Model::n_state; ++c) options.record.states.push_back(c);
    for (int c = 0; c < Model::n_accessory; ++c) options.record.accessories.push_back(c);
    for (int c = 0; c < Model::n_integer_accessory; ++c) options.record.integer_accessories.push_back(c);
    return myriad::solve<Method>(myriad::device::cpu(1), e, options);
}

/// Equal where neither is NaN, which samples are beyond the last.
template <class Array>
bool same(const Array& a, const Array& b) {
    return (a == b || (a.isNaN() && b.isNaN())).all();
}
template <class Alone, class Together>
void compare(const myriad::ensemble<Alone>& alone, const myriad::ensemble<Together>& together,
             const std::vector<int>& sampled = {}) {
    for (std::int64_t i = 0; i < alone.size(); ++i) CHECK(alone.status(i) == together.status(i));
    for (int c = 0; c < Alone::n_state; ++c) CHECK((alone.state(c) == together.state(c)).all());
    for (int c = 0; c < Alone::n_parameter; ++c) CHECK((alone.parameter(c) == together.parameter(c)).all());
    for (int c = 0; c < Alone::n_accessory; ++c) CHECK((alone.accessory(c) == together.accessory(c)).all());
    for (int c = 0; c < Alone::n_integer_accessory; ++c)
        CHECK((alone.integer_accessory(c) == together.integer_accessory(c)).all());
    CHECK((alone.t() == together.t()).all());
    for (std::int64_t i = 0; i < alone.size(); ++i) CHECK(alone.t_end_of(i) == together.t_end_of(i));
    if (!alone.samples().empty()) {
        CHECK(alone.samples().stored().minCoeff() > 3);
        CHECK((alone.samples().stored() == together.samples().stored()).all());
        CHECK(same(alone.samples().time(), together.samples().time()));
        for (const int c : sampled) CHECK(same(alone.samples().state(c), together.samples().state(c)));
    }
    CHECK((alone.accepted_steps() == together.accepted_steps()).all());
    CHECK((alone.rejected_steps() == together.rejected_steps()).all());
    CHECK((alone.rhs_evaluations() == together.rhs_evaluations()).all());
}
template <class Method, class Alone, class Together>
void compare(myriad::options options, const std::vector<int>& sampled = {}) {
    for (const int c : sampled) options.samples.states.push_back(c);
    for (const auto order : {teams::order::first_thread_first, teams::order::last_thread_first}) {
        teams::order_of_threads = order;
        auto alone = ensemble_of<Alone>();
        auto together = ensemble_of<Together>();
        const auto by_one = integrate<Method>(alone, options);
        const auto by_team = integrate<Method>(together, options);
        CHECK(alone.accepted_steps().minCoeff() > 3);
        compare(alone, together, sampled);
        for (int c = 0; c < Alone::n_state; ++c) CHECK((by_one.records.state(c) == by_team.records.state(c)).all());
        for (int c = 0; c < Alone::n_accessory; ++c)
            CHECK((by_one.records.accessory(c) == by_team.records.accessory(c)).all());
        for (int c = 0; c < Alone::n_integer_accessory; ++c)
            CHECK((by_one.records.integer_accessory(c) == by_team.records.integer_accessory(c)).all());
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

using teams::adapting_cells;
using teams::drifters;
using teams::hoppers;
using teams::metered_line;
using teams::noisy_places;
using teams::noisy_points;
using teams::phases;
using teams::places;
using teams::ring;
using teams::watched_ring;

}  // namespace

TEST_CASE("a team of threads integrates units that read each other's states as one thread does") {
    compare<teams::with_memory, places<1>, places<4>>(tolerances(30));
    compare<teams::with_memory, places<1>, places<16>>(tolerances(30));
    compare<myriad::dormand_prince_8, places<1>, places<64>>(tolerances(30));
}

TEST_CASE("a team of threads takes fixed steps as one thread does") {
    compare<myriad::runge_kutta_4, places<1>, places<8>>({.step = 0.01});
}

TEST_CASE("phases of fixed steps end in a team where they do in one thread, at their end, by a failure or by a limit") {
    myriad::options phases{.phases = 3, .step = 0.01};
    phases.phase_length = 0.4;
    compare<myriad::runge_kutta_4, places<1>, places<8>>(phases);
    for (const auto order : {teams::order::first_thread_first, teams::order::last_thread_first}) {
        teams::order_of_threads = order;
        auto alone = ensemble_of<places<1>>();
        auto together = ensemble_of<places<8>>();
        alone.parameter(0)[2] = together.parameter(0)[2] = 1e308;  // overflows after some steps
        myriad::options limited{.step = 0.3};
        limited.max_steps = 4;
        integrate<myriad::runge_kutta_4>(alone, limited);
        integrate<myriad::runge_kutta_4>(together, limited);
        CHECK(together.status(0) == myriad::status::max_steps);
        CHECK(together.status(2) == myriad::status::not_finite);
        compare(alone, together);
    }
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

TEST_CASE("a team of threads samples along the solution, and by steps, as one thread does") {
    myriad::options options = tolerances(30);
    options.samples = {.capacity = 40, .evenly = 17};
    compare<teams::sampled, places<1>, places<4>>(options, {0, 7, 28, 29});
    options.samples = {.capacity = 6, .every = 2};
    compare<teams::sampled, places<1>, places<4>>(options, {3, 29});
}

TEST_CASE("a team of threads averages errors over all states as one thread does") {
    compare<teams::averaged, places<1>, places<16>>(tolerances(30));
}

TEST_CASE("a team of threads locates events and calls hooks as one thread does") {
    myriad::options options = tolerances(28);
    for (int unit = 0; unit < hoppers<1>::n_unit; ++unit) {
        options.events.push_back({.direction = myriad::direction::falling, .tolerance = unit % 3 == 0 ? 0 : 1e-8});
        options.events.push_back({.stop_after = unit == 5 ? 4 : 0});
    }
    options.phases = 3;
    options.phase_time = myriad::phase_time::carry_on;
    options.phase_length = 0.8;
    compare<myriad::cash_karp, hoppers<1>, hoppers<4>>(options);
    compare<myriad::cash_karp, hoppers<1>, hoppers<16>>(options);
    options.samples = {.capacity = 100, .evenly = 20};
    compare<teams::sampled_8, hoppers<1>, hoppers<8>>(options, {0, 1, 27});
}

TEST_CASE("a team of threads calls hooks that move the end of the phase as one thread does") {
    compare<myriad::dormand_prince_5, drifters<1>, drifters<8>>(tolerances(21));
    compare<myriad::runge_kutta_4, drifters<1>, drifters<2>>({.step = 0.01});
}

TEST_CASE("a team of threads finds extrema and integrals along the solution as one thread does") {
    myriad::options options = tolerances(22);
    options.phases = 2;
    options.phase_length = 0.7;
    options.phase_time = myriad::phase_time::carry_on;
    compare<myriad::cash_karp, watched_ring<1>, watched_ring<4>>(options);
    compare<myriad::dormand_prince_8, watched_ring<1>, watched_ring<8>>(options);
    compare<myriad::runge_kutta_4, metered_line<1>, metered_line<8>>({.step = 0.01});
    options = tolerances(18);
    options.samples = {.capacity = 40, .evenly = 17};
    compare<teams::sampled, metered_line<1>, metered_line<16>>(options, {0, 17});
}

TEST_CASE("what a unit observes of the others' summaries is the same in a team as in one thread") {
    compare<myriad::cash_karp, teams::envious_ring<1>, teams::envious_ring<8>>(tolerances(18));
}

TEST_CASE("a team of threads sees accessories and parameters that hooks and summaries write as one thread does") {
    myriad::options options = tolerances(17);
    options.phases = 2;
    compare<myriad::cash_karp, adapting_cells<1>, adapting_cells<4>>(options);
    compare<myriad::dormand_prince_5, adapting_cells<1>, adapting_cells<16>>(options);
    const auto start = ensemble_of<adapting_cells<4>>();
    options.phases = 1;
    auto e = ensemble_of<adapting_cells<4>>();
    integrate<myriad::cash_karp>(e, options);
    CHECK(e.integer_accessory(1).minCoeff() >= 1);  // all that hooks do is done
    CHECK((e.parameter(2) < start.parameter(2)).all());
    CHECK(e.integer_accessory(adapting_cells<4>::unit_type::mode).minCoeff() >= 1);
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

TEST_CASE("units with noise of their own have the same paths written as a whole, in one thread and in teams") {
    const auto steps = [](double step) {
        myriad::options o{.step = step, .seed = 5, .noise_step = 0.02};
        o.phases = 2;
        o.phase_length = 0.7;
        return o;
    };
    auto whole = ensemble_of<teams::whole_of_points>();
    auto units = ensemble_of<noisy_points<1>>();
    integrate<myriad::euler_maruyama>(whole, steps(0.02));
    integrate<myriad::euler_maruyama>(units, steps(0.02));
    for (int c = 0; c < teams::whole_of_points::n_state; ++c) CHECK((whole.state(c) == units.state(c)).all());
    CHECK((whole.state(0) - whole.state(1)).abs().minCoeff() > 0);
    compare<myriad::euler_maruyama, noisy_points<1>, noisy_points<4>>(steps(0.02));
    compare<myriad::sra1, noisy_points<1>, noisy_points<16>>(steps(0.01));
    compare<myriad::milstein, noisy_places<1>, noisy_places<4>>(steps(0.02));
    auto by_halves = tolerances(22);
    by_halves.relative_tolerance = 1e-3;
    by_halves.absolute_tolerance = 1e-3;
    by_halves.seed = 5;
    compare<teams::sriw1_by_halves, noisy_places<1>, noisy_places<8>>(by_halves);
}

TEST_CASE("noise of units is found to be additive, or to depend on each state's own alone") {
    using namespace myriad::detail;
    CHECK(is_additive<myriad::coupled_units<teams::noisy_point, 100>>);
    CHECK_FALSE(is_additive<myriad::coupled_units<teams::noisy_place, 100>>);
    CHECK_FALSE(dependence_of_noise<myriad::coupled_units<teams::noisy_place, 100>>.on_other_states);
}
