// SPDX-License-Identifier: MIT
// Keller-Miksis bubbles of 10 um in water, under one or two frequencies, over one period of the first.
#include "keller_miksis.hpp"

#include <cmath>
#include <numbers>

#include "../runner.hpp"
#include "problems.hpp"

namespace validation {
namespace {

/// The constants C0 to C12 for pressure amplitudes (Pa) and frequencies (Hz). Water at 25 C, a gas bubble; SI units.
std::vector<double> bubble(double amplitude_1, double amplitude_2, double frequency_1, double frequency_2) {
    constexpr double pi = std::numbers::pi, vapour = 3166.775638952003, density = 997.0639504998557;
    constexpr double tension = 0.071977583160056, viscosity = 8.902125058209557e-4, sound = 1497.251785455527;
    constexpr double gamma = 1.4, ambient = 1e5, radius = 10e-6, phase = 0;
    const double omega_1 = 2 * pi * frequency_1, omega_2 = 2 * pi * frequency_2, q = 2 * pi / (radius * omega_1);
    const double excess = ambient - vapour + 2 * tension / radius;
    return {excess * q * q / density,
            (1 - 3 * gamma) * excess * q / (density * sound),
            (ambient - vapour) * q * q / density,
            2 * tension * q * q / (density * radius),
            4 * viscosity / (density * radius * radius) * 2 * pi / omega_1,
            amplitude_1 * q * q / density,
            amplitude_2 * q * q / density,
            radius * omega_1 * amplitude_1 * q * q / (density * sound),
            radius * omega_2 * amplitude_2 * q * q / (density * sound),
            radius * omega_1 / (2 * pi * sound),
            3 * gamma,
            omega_2 / omega_1,
            phase / pi};
}

}  // namespace

problem keller_miksis_problem() {
    problem p;
    p.name = "keller_miksis";
    p.what =
        "Keller-Miksis bubbles of 10 um over one period of the first forcing: 32 with 0.8 bar of 100 to 1000 kHz, 32 "
        "with 0.5 bar of 100 to 1000 kHz and 0.4 bar of 300 kHz; largest and smallest radii";
    for (const double logarithm : spread(5, 6, 32))
        p.instances.push_back({{1, 0}, bubble(0.8e5, 0, std::pow(10, logarithm), 1e5), 1});
    for (const double logarithm : spread(5, 6, 32))
        p.instances.push_back({{1, 0}, bubble(0.5e5, 0.4e5, std::pow(10, logarithm), 3e5), 1});
    p.events = {{.direction = myriad::direction::falling, .tolerance = 1e-11},
                {.direction = myriad::direction::rising, .tolerance = 1e-11}};
    p.event_times = {keller_miksis::t_maximum, keller_miksis::t_minimum};
    p.events_per_instance = 10;
    p.sampled = {keller_miksis::y};
    p.fixed_step = 0.0005;
    complete<keller_miksis>(p);
    return p;
}

}  // namespace validation
