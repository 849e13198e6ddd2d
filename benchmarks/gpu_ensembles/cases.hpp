// SPDX-License-Identifier: MIT
// The cases of the benchmark: their equations, sizes, and checks of results.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "measure.hpp"

namespace gpu_ensembles {

struct benchmark_case {
    std::string name;
    std::string work;   ///< description of the work, for the header
    std::string error;  ///< meaning of max_error
    double allowed_error;
    std::vector<std::int64_t> sizes;
    /// Measures all implementations at one size.
    std::function<std::vector<measurement>(std::int64_t size, const measure_options&)> measure;
};

/// lorenz_rk4, and lorenz_tsit5 at three tolerances.
std::vector<benchmark_case> lorenz_cases();
/// Lorenz 96 with 4 to 512 states.
std::vector<benchmark_case> lorenz96_cases();
/// Seven stars with near collisions.
benchmark_case pleiades_case();
benchmark_case van_der_pol_case();
/// Hodgkin and Huxley's axon, and 8, 16 and 32 of Kuramoto's oscillators.
std::vector<benchmark_case> heavy_cases();
/// Geometric Brownian motion, and a chemical Langevin equation.
std::vector<benchmark_case> noise_cases();
benchmark_case delays_case();
/// Coupled units with delays, by one thread of a GPU and by teams.
benchmark_case delayed_units_case();
benchmark_case keller_miksis_case();
benchmark_case relief_valve_case();
benchmark_case duffing_events_case();
/// Both by methods of higher order.
std::vector<benchmark_case> method_cases();
benchmark_case schedule_case();
/// Networks of 3 to 64 states by stiff methods.
std::vector<benchmark_case> stiff_cases();

/// A value published with the paper's package, for the same work.
struct check_value {
    std::string name;
    double value, expected, allowed;
    bool right() const { return value >= expected - allowed && value <= expected + allowed; }
};
std::vector<check_value> check_lorenz(const myriad::device& device);
std::vector<check_value> check_relief_valve(const myriad::device& device);

}  // namespace gpu_ensembles
