// SPDX-License-Identifier: MIT
// The sweeps of the bubble and of the valve: parameters, starts and rules of events. Host code.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include <myriad/myriad.hpp>

#include "models.hpp"

namespace gpu_ensembles {

// Water at 25 C, a gas bubble of 10 um, driven with 1.5 bar at f1 = logspace(20 kHz, 1000 kHz, N) and not driven at f2. SI
// units.
inline void fill_bubbles(myriad::ensemble<keller_miksis>& instances) {
    using model = keller_miksis;
    constexpr double pi = std::numbers::pi;
    constexpr double vapour_pressure = 3166.775638952003, density = 997.0639504998557;
    constexpr double surface_tension = 0.071977583160056, viscosity = 8.902125058209557e-4;
    constexpr double sound_speed = 1497.251785455527, polytropic_exponent = 1.4, ambient_pressure = 1e5;
    constexpr double radius = 10e-6, amplitude_1 = 1.5e5, amplitude_2 = 0, phase_shift = 0;
    constexpr double excess = ambient_pressure - vapour_pressure + 2 * surface_tension / radius;
    const Eigen::ArrayXd logarithm =
        Eigen::ArrayXd::LinSpaced(instances.size(), std::log10(20e3), std::log10(1000e3));  // of f1 in Hz
    for (std::int64_t i = 0; i < instances.size(); ++i) {
        const double omega_1 = 2 * pi * std::pow(10.0, logarithm[i]), omega_2 = omega_1;
        const double q = 2 * pi / (radius * omega_1);
        const double C[model::n_parameter] = {
            excess * q * q / density,
            (1 - 3 * polytropic_exponent) * excess * q / (density * sound_speed),
            (ambient_pressure - vapour_pressure) * q * q / density,
            2 * surface_tension * q * q / (density * radius),
            4 * viscosity / (density * radius * radius) * 2 * pi / omega_1,
            amplitude_1 * q * q / density,
            amplitude_2 * q * q / density,
            radius * omega_1 * amplitude_1 * q * q / (density * sound_speed),
            radius * omega_2 * amplitude_2 * q * q / (density * sound_speed),
            radius * omega_1 / (2 * pi * sound_speed),
            3 * polytropic_exponent,
            omega_2 / omega_1,
            phase_shift / pi,
        };
        for (int c = 0; c < model::n_parameter; ++c) instances.parameter(c)[i] = C[c];
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
            .accumulation_limit = 25};  // fewer than the steps after which a valve is at rest
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
