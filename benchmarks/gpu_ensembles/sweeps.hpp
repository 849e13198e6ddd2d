// SPDX-License-Identifier: MIT
// The sweeps of the bubble and of the valve: parameters, starts and event options. Host code.
#pragma once

#include <cmath>
#include <limits>

#include <myriad/myriad.hpp>

#include "examples/keller_miksis/constants.hpp"
#include "models.hpp"

namespace gpu_ensembles {

// Bubbles driven with 1.5 bar at f1 = geomspace(20 kHz, 1000 kHz, N) and not driven at f2.
inline void fill_bubbles(myriad::ensemble<keller_miksis>& instances) {
    using model = keller_miksis;
    const Eigen::ArrayXd logarithm =
        Eigen::ArrayXd::LinSpaced(instances.size(), std::log10(20e3), std::log10(1000e3));  // of f1 in Hz
    for (std::int64_t i = 0; i < instances.size(); ++i) {
        const double f = std::pow(10.0, logarithm[i]);
        const auto C = bubble::constants({1.5e5, f}, {0, f});
        static_assert(C.size() == model::n_parameter);
        for (int c = 0; c < model::n_parameter; ++c) instances.parameter(c)[i] = C[static_cast<std::size_t>(c)];
    }
    instances.time_domain(0, 1);
}

inline void start_bubbles(myriad::ensemble<keller_miksis>& instances) {
    instances.state(keller_miksis::y) = 1;
    instances.state(keller_miksis::v) = 0;
    instances.accessory(keller_miksis::y_max) = 1;
}

inline void fill_valves(myriad::ensemble<relief_valve>& instances) {
    using model = relief_valve;
    instances.parameter(model::q) = Eigen::ArrayXd::LinSpaced(instances.size(), 0.2, 10);
    instances.shared(model::kappa) = 1.25;
    instances.shared(model::delta) = 10;
    instances.shared(model::beta) = 20;
    instances.shared(model::restitution) = 0.8;
    instances.shared(model::rest_band) = 1e-6;
    instances.time_domain(0, std::numeric_limits<double>::infinity());
}

inline void start_valves(myriad::ensemble<relief_valve>& instances) {
    using model = relief_valve;
    instances.state(model::y) = 0.2;
    instances.state(model::v) = 0;
    instances.state(model::u) = 0;
    for (const auto c : {model::lowest, model::highest, model::rest_at}) instances.accessory(c) = 0.2;
    instances.integer_accessory(model::steps_at_rest) = 0;
}

/// Phases of valves, each from one fall of the velocity through zero to the next.
inline myriad::options valve_options(std::int64_t phases, double tolerance, double event_tolerance) {
    return {.phases = phases,
            .relative_tolerance = tolerance,
            .absolute_tolerance = tolerance,
            .step = 1e-2,
            .minimum_step = 1e-12,
            .maximum_step = 1e6,
            .max_steps = 1'000'000,
            .events = {{.direction = myriad::direction::falling, .tolerance = event_tolerance, .stop_after = 1},
                       {.direction = myriad::direction::falling, .tolerance = event_tolerance}},
            .accumulation_limit = 25};  // fewer than the number of steps after which a valve is at rest
}

/// Periods of bubbles.
inline myriad::options bubble_options(std::int64_t phases, double tolerance) {
    return {.phases = phases,
            .relative_tolerance = tolerance,
            .absolute_tolerance = tolerance,
            .step = 1e-2,
            .minimum_step = 1e-12,
            .maximum_step = 1e6};
}

}  // namespace gpu_ensembles
