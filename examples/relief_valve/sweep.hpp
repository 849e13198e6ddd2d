// SPDX-License-Identifier: MIT
// The sweep of the relief valve over its flow, as in the MPGOS paper: constants, start and options. Host code.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include <myriad/myriad.hpp>

#include "../common/grid.hpp"
#include "relief_valve.hpp"
#include "relief_valve_contact.hpp"

namespace relief_valve_sweep {

inline constexpr double kappa = 1.25, delta = 10, beta = 20, restitution = 0.8, rest_band = 1e-6;
inline constexpr double q_first = 0.2, q_last = 10;
inline constexpr double tolerance = 1e-10, event_tolerance = 1e-6;
// With resting contact: speed after the last impact, and the tolerance of the seat's location and of the opening force.
inline constexpr double slowest = 1e-4, contact_tolerance = 1e-12;

/// The constants, for a table's header.
inline std::string constants() {
    return myriad::message("dimensionless; kappa = ", kappa, ", delta = ", delta, ", beta = ", beta, ", restitution ",
                           restitution, ", start (0.2, 0, 0)");
}

/// `Model`: relief_valve, or one with resting contact.
template <class Model = relief_valve>
myriad::ensemble<Model> prepare(std::int64_t instances, double first = q_first, double last = q_last) {
    myriad::ensemble<Model> sweep(instances);
    sweep.parameter(Model::q) = examples::linspace(first, last, instances);
    sweep.shared(Model::kappa) = kappa;
    sweep.shared(Model::delta) = delta;
    sweep.shared(Model::beta) = beta;
    sweep.shared(Model::restitution) = restitution;
    sweep.shared(Model::rest_band) = rest_band;
    sweep.state(Model::y) = 0.2;
    sweep.state(Model::v) = 0;
    sweep.state(Model::u) = 0;
    sweep.time_domain(0, std::numeric_limits<double>::infinity());  // the section ends a phase, or rest does
    return sweep;
}

inline myriad::ensemble<relief_valve_contact> prepare_contact(std::int64_t instances, double first, double last) {
    auto sweep = prepare<relief_valve_contact>(instances, first, last);
    sweep.shared(relief_valve_contact::slowest) = slowest;
    return sweep;
}

// The limit on impacts on the spot is below the 50 steps after which a valve counts as resting, so that one whose
// impacts accumulate ends as event_accumulation and not as resting on its seat.
inline myriad::options integration(std::int64_t phases) {
    return {.phases = phases,
            .relative_tolerance = tolerance,
            .absolute_tolerance = tolerance,
            .step = 1e-2,
            .minimum_step = 1e-12,
            .maximum_step = 1e6,
            .events = {{.direction = myriad::direction::falling, .tolerance = event_tolerance, .stop_after = 1},
                       {.direction = myriad::direction::falling, .tolerance = event_tolerance}},
            .accumulation_limit = 25};
}

// snippet: contact
inline myriad::options integration_with_contact(std::int64_t phases) {
    auto options = integration(phases);
    options.absolute_tolerance = {1e-15, 1e-12, 1e-10};  // y and v of bounces 1e-9 high
    options.events[relief_valve::seat].tolerance = contact_tolerance;
    options.events.push_back({.direction = myriad::direction::rising, .tolerance = contact_tolerance});
    return options;
}
// end of snippet

}  // namespace relief_valve_sweep
