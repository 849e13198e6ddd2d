// SPDX-License-Identifier: MIT
// The case keller_miksis_cash_karp: its physical constants, what it integrates, and Myriad's call.
#include <cmath>
#include <numbers>

#include "../cases.hpp"
#include "../myriad_run.hpp"
#include "equations.hpp"
#include "model.hpp"

namespace cpu_peers {
namespace {

using dormand_prince_8_pi = myriad::controlled<myriad::dormand_prince_8, myriad::pi_control>;

using model = keller_miksis_model;

template <class Method>
outcome run(const sweep& work) {
    return run_myriad<Method, model>(work,
                                     {.phases = work.phases,
                                      .relative_tolerance = work.tolerance,
                                      .absolute_tolerance = work.tolerance,
                                      .step = keller_miksis::first_step,
                                      .minimum_step = 1e-12,
                                      .maximum_step = 1e6},
                                     [](auto& instances) { instances.time_domain(0, 1); });
}

// Water at 25 C, a gas bubble of 10 um, driven at f1 with 1.5 bar and not driven at f2. SI units.
void fill(std::int64_t instances, double* parameters, double* states) {
    constexpr double pi = std::numbers::pi;
    constexpr double vapour_pressure = 3166.775638952003, density = 997.0639504998557;
    constexpr double surface_tension = 0.071977583160056, viscosity = 8.902125058209557e-4;
    constexpr double sound_speed = 1497.251785455527, polytropic_exponent = 1.4, ambient_pressure = 1e5;
    constexpr double radius = 10e-6, amplitude_1 = 1.5e5, amplitude_2 = 0, phase_shift = 0;
    const Eigen::ArrayXd logarithm =
        Eigen::ArrayXd::LinSpaced(instances, std::log10(20e3), std::log10(1000e3));  // of f1 in Hz
    for (std::int64_t i = 0; i < instances; ++i) {
        const double omega_1 = 2 * pi * std::pow(10.0, logarithm[i]), omega_2 = omega_1;
        const double q = 2 * pi / (radius * omega_1);
        const double excess = ambient_pressure - vapour_pressure + 2 * surface_tension / radius;
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
        for (int c = 0; c < model::n_parameter; ++c) parameters[c * instances + i] = C[c];
        states[i] = 1;
        states[instances + i] = 0;
    }
}

}  // namespace

benchmark_case keller_miksis_cash_karp() {
    return {.name = "keller_miksis_cash_karp",
            .work =
                "4 phases tau in [0, 1], t and step restarted in each, tolerances 1e-10, one frequency f1 = "
                "logspace(20 kHz, 1000 kHz, N) at 1.5 bar, start (1, 0), largest radius kept",
            .difference = "state after 1 phase (some instances are chaotic), against order 8 in long double at 1e-16",
            .allowed_difference = 1e-8,
            .tolerance = 1e-10,
            .event_tolerance = 0,
            .components = 2,
            .parameters = model::n_parameter,
            .instances = 1024,
            .phases = 4,
            .compared_phases = 1,
            .fill = fill,
            .reference = keller_miksis::run_reference,
            .implementations = {{"odeint", "odeint", keller_miksis::run_odeint},
                                {"loop", "loop", keller_miksis::run_loop},
                                {"myriad", "myriad", run<myriad::cash_karp>}},
            .at_equal_error = {
                .phases = 2,
                .contenders = {{"cvode_adams", "cvode", keller_miksis::run_cvode},
                               {"odeint", "odeint", keller_miksis::run_odeint},
                               {"cash_karp", "myriad", run<myriad::cash_karp>},
                               {"verner_7", "myriad", if_compiled<myriad::verner_7, model>(run<myriad::verner_7>)},
                               {"dormand_prince_8 pi", "myriad",
                                if_compiled<dormand_prince_8_pi, model>(run<dormand_prince_8_pi>)}}}};
}

}  // namespace cpu_peers
