// SPDX-License-Identifier: MIT
// Keller-Miksis bubbles of 10 um in water, under one or two frequencies, over one period of the first.
#include "keller_miksis.hpp"

#include <cmath>

#include "../runner.hpp"
#include "examples/keller_miksis/constants.hpp"
#include "problems.hpp"

namespace validation {
namespace {

/// The constants C0 to C12 for pressure amplitudes (Pa) and frequencies (Hz).
std::vector<double> bubble_in_water(double amplitude_1, double amplitude_2, double frequency_1, double frequency_2) {
    const auto C = bubble::constants({amplitude_1, frequency_1}, {amplitude_2, frequency_2});
    return {C.begin(), C.end()};
}

}  // namespace

problem keller_miksis_problem() {
    problem p;
    p.name = "keller_miksis";
    p.what =
        "Keller-Miksis bubbles of 10 um over one period of the first forcing: 32 with 0.8 bar of 100 to 1000 kHz, 32 "
        "with 0.5 bar of 100 to 1000 kHz and 0.4 bar of 300 kHz; largest and smallest radii";
    for (const double logarithm : spread(5, 6, 32))
        p.instances.push_back({{1, 0}, bubble_in_water(0.8e5, 0, std::pow(10, logarithm), 1e5), 1});
    for (const double logarithm : spread(5, 6, 32))
        p.instances.push_back({{1, 0}, bubble_in_water(0.5e5, 0.4e5, std::pow(10, logarithm), 3e5), 1});
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
