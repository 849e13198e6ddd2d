// SPDX-License-Identifier: MIT
// A team of threads integrates coupled units with delays as one thread does, bit for bit.
#include <cmath>
#include <cstdint>

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/kernel/model/delayed_teams.hpp"

namespace {

using delayed_teams::cells;
using delayed_teams::echo;
using delayed_teams::echoes;
using delayed_teams::pairs;
using delayed_teams::phases;
using delayed_units::cell;

constexpr std::int64_t instances = 3;

template <class Alone, class Together>
void check_same(const myriad::ensemble<Alone>& alone, const myriad::ensemble<Together>& together) {
    for (std::int64_t i = 0; i < alone.size(); ++i) {
        CAPTURE(i);
        CHECK(alone.status(i) == together.status(i));
        for (int c = 0; c < Alone::n_state; ++c) CHECK(alone.state(c)[i] == together.state(c)[i]);
        for (int c = 0; c < Alone::n_parameter; ++c) CHECK(alone.parameter(c)[i] == together.parameter(c)[i]);
        for (int c = 0; c < Alone::n_accessory; ++c) CHECK(alone.accessory(c)[i] == together.accessory(c)[i]);
        CHECK(alone.t()[i] == together.t()[i]);
        CHECK(alone.accepted_steps()[i] == together.accepted_steps()[i]);
        CHECK(alone.rejected_steps()[i] == together.rejected_steps()[i]);
        CHECK(alone.rhs_evaluations()[i] == together.rhs_evaluations()[i]);
    }
}
/// Solves both, filled alike, with the threads in either order, in two calls if there is a second end. Shows what one
/// thread has found.
template <class Method, class Alone, class Together, class Fill, class Show>
void compare(myriad::options options, const Fill& fill, const Show& show, double second_end = 0) {
    options.advice = myriad::advice::off;
    for (const auto order : {teams::order::first_thread_first, teams::order::last_thread_first}) {
        teams::order_of_threads = order;
        myriad::ensemble<Alone> alone(instances);
        myriad::ensemble<Together> together(instances);
        fill(alone);
        fill(together);
        const auto solve = [&](auto& e) {
            myriad::solve<Method>(myriad::device::cpu(1), e, options);
            if (second_end == 0) return;
            e.time_domain(e.t()[0], second_end);
            e.state(4) = e.state(4) + 0.1;  // which one thread has
            myriad::solve<Method>(myriad::device::cpu(1), e, options);
        };
        solve(alone);
        solve(together);
        check_same(alone, together);
        show(alone);
    }
}
constexpr auto all_succeed = [](const auto& found) {
    for (std::int64_t i = 0; i < instances; ++i) CHECK(found.status(i) == myriad::status::success);
};
template <class Model>
void fill_states(myriad::ensemble<Model>& e) {
    for (std::int64_t i = 0; i < instances; ++i)
        for (int c = 0; c < Model::n_state; ++c)
            e.state(c)[i] = 0.1 * static_cast<double>((7 * c + 3 * static_cast<int>(i)) % 11) - 0.4;
}
constexpr auto fill_phases = [](auto& e) {
    fill_states(e);
    e.parameter(delayed_units::phase::K) = 0.9;
    e.parameter(delayed_units::phase::tau) = Eigen::ArrayXd::LinSpaced(instances, 0.02, 0.9);
    for (int u = 0; u < 19; ++u) {
        e.parameter(2 + u) = 1 + 0.5 * std::sin(u);
        for (int v = 0; v < 19; ++v) e.shared(v * 19 + u) = (1 + 0.1 * ((u + 2 * v) % 5)) / 19;
    }
    e.time_domain(0, 3);
};
constexpr auto fill_cells = [](auto& e) {
    e.parameter(cell::a) = Eigen::ArrayXd::LinSpaced(instances, 0.5, 2);
    e.parameter(cell::b) = 1.2;
    for (int u = 0; u < cell::units; ++u) {
        e.parameter(2 + 2 * u) = 0.3 + 0.2 * u;
        e.parameter(3 + 2 * u) = 1.7 - 0.25 * u;
        e.state(2 * u) = std::cos(u) + 0.1;
        e.state(2 * u + 1) = 0.0;
    }
    e.time_domain(0, 4);
};
constexpr auto fill_echoes = [](auto& e) {
    fill_states(e);
    e.parameter(echo::strength) = Eigen::ArrayXd::LinSpaced(instances, 1, 2);
    for (int u = 0; u < echo::units; ++u) e.parameter(1 + u) = 0.4 + 0.1 * u;
    e.time_domain(0, 0.8);
};
myriad::options tolerance(double value, std::int64_t history_steps) {
    myriad::options options;
    options.relative_tolerance = options.absolute_tolerance = value;
    options.history_steps = history_steps;
    return options;
}

}  // namespace

TEST_CASE("a team of threads looks up what all units published a while ago as one thread does") {
    // Lags from a tenth of a step on, so that steps are iterated, to many steps.
    const auto is_iterated = [](const auto& found) {
        all_succeed(found);
        CHECK(found.rhs_evaluations()[0] > 8 * (found.accepted_steps()[0] + found.rejected_steps()[0]));
    };
    compare<myriad::tsitouras_5, phases<1>, phases<8>>(tolerance(1e-6, 64), fill_phases, is_iterated, 5);
}

TEST_CASE("a team of threads takes fixed steps with delays as one thread does") {
    myriad::options options{.step = 0.02};
    compare<myriad::runge_kutta_4, phases<1>, phases<4>>(options, fill_phases, all_succeed);
    options.phases = 2;
    options.phase_length = 0.6;
    options.step = 0.05;
    options.history_steps = 16384;  // each action arrives by 14 lags
    compare<myriad::runge_kutta_4, echoes<1>, echoes<8>>(options, fill_echoes, all_succeed);
}

TEST_CASE("a team of threads has conduction times of each pair, histories, and events of delayed values as one has") {
    const auto has_events = [](const auto& found) {
        all_succeed(found);
        for (int u = 0; u < cell::units; ++u) CHECK(found.state(2 * u + 1).maxCoeff() > 1);
    };
    compare<myriad::dormand_prince_5, cells<1>, cells<4>>(tolerance(1e-7, 1024), fill_cells, has_events);
}

TEST_CASE("a team of threads has a conduction time for each of many pairs as one thread has") {
    const auto fill = [](auto& e) {
        fill_states(e);
        e.parameter(0) = 0.5;
        // Lags a little, and much, shorter than the steps.
        e.parameter(1) = Eigen::ArrayXd::LinSpaced(instances, 6, 50.5);
        for (int k = 0; k < 81; ++k) e.shared(k) = 0.3 + 0.01 * ((37 * k) % 81);
        e.time_domain(0, 1.5);
    };
    const auto is_iterated = [](const auto& found) {
        all_succeed(found);
        constexpr auto last = instances - 1;
        CHECK(found.rhs_evaluations()[last] > 7 * (found.accepted_steps()[last] + found.rejected_steps()[last]));
    };
    compare<myriad::dormand_prince_5, pairs<1>, pairs<4>>(tolerance(1e-5, 8192), fill, is_iterated);
}

TEST_CASE("a team of threads has actions, stops, slopes of the past and phases with delays as one thread has") {
    const auto has_stops = [](const auto& found) {
        all_succeed(found);
        CHECK(found.parameter(echo::strength).minCoeff() > 1);
    };
    myriad::options options = tolerance(1e-6, 16384);  // each action arrives by 14 lags
    options.phases = 2;
    for (const double length : {0.0, 0.5}) {  // from t_begin again, whereto the past moves, or on
        options.phase_length = length;
        compare<myriad::cash_karp, echoes<1>, echoes<4>>(options, fill_echoes, has_stops);
    }
}

TEST_CASE("a delay that cannot be and a ring that is too short are the statuses of all threads of a team") {
    const auto fill = [](auto& e) {
        fill_cells(e);
        e.parameter(2 + 2 * 4)[1] = -1;  // of one unit, which one thread has
        e.parameter(3 + 2 * 1)[2] = 3.9;
        e.time_domain(0, 12);
    };
    compare<myriad::dormand_prince_5, cells<1>, cells<4>>(tolerance(1e-7, 64), fill, [](const auto& found) {
        CHECK(found.status(1) == myriad::status::invalid_delay);
        CHECK(found.status(2) == myriad::status::history_overflow);
    });
}
