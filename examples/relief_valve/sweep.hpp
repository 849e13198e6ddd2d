// SPDX-License-Identifier: MIT
// The sweep of the relief valve over its flow, as in the MPGOS paper: constants, start and options. Host code.
#pragma once

#include <cstdint>
#include <limits>

#include <myriad/myriad.hpp>

#include "relief_valve.hpp"

namespace relief_valve_sweep {

inline constexpr double kappa = 1.25, delta = 10, beta = 20, restitution = 0.8, rest_band = 1e-6;
inline constexpr double q_first = 0.2, q_last = 10;
inline constexpr double tolerance = 1e-10, event_tolerance = 1e-6;

inline myriad::ensemble<relief_valve> prepare(std::int64_t instances) {
    myriad::ensemble<relief_valve> sweep(instances);
    sweep.parameter(relief_valve::q) = q_first;  // LinSpaced would give a single one the last value
    if (instances > 1) sweep.parameter(relief_valve::q) = Eigen::ArrayXd::LinSpaced(instances, q_first, q_last);
    sweep.shared(relief_valve::kappa) = kappa;
    sweep.shared(relief_valve::delta) = delta;
    sweep.shared(relief_valve::beta) = beta;
    sweep.shared(relief_valve::restitution) = restitution;
    sweep.shared(relief_valve::rest_band) = rest_band;
    sweep.state(relief_valve::y) = 0.2;
    sweep.state(relief_valve::v) = 0;
    sweep.state(relief_valve::u) = 0;
    sweep.time_domain(0, std::numeric_limits<double>::infinity());  // the section ends a phase, or rest does
    return sweep;
}

// Impacts on the spot are counted to fewer than the 50 steps after which a valve counts as resting, so that one whose
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

}  // namespace relief_valve_sweep
