// SPDX-License-Identifier: MIT
// The case keller_miksis: a bubble in water at one frequency, whose instances differ 50-fold in cost.
#include <cmath>
#include <numbers>

#include "cases.hpp"
#include "models.hpp"
#include "reference.hpp"

namespace gpu_ensembles {
namespace {

// Water at 25 C, a gas bubble of 10 um, driven at f1 with 1.5 bar and not driven at f2. SI units.
void fill(myriad::ensemble<keller_miksis>& instances) {
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

void start(myriad::ensemble<keller_miksis>& instances) {
    instances.state(keller_miksis::y) = 1;
    instances.state(keller_miksis::v) = 0;
    instances.accessory(keller_miksis::y_max) = 1;
}

std::vector<measurement> measure(std::int64_t size, const measure_options& how) {
    const problem<keller_miksis> what{{.phases = 64,
                                       .relative_tolerance = 1e-10,
                                       .absolute_tolerance = 1e-10,
                                       .step = 1e-2,
                                       .minimum_step = 1e-12,
                                       .maximum_step = 1e6},
                                      &fill,
                                      &start};
    return {measure_myriad<myriad::cash_karp>(what, size, how, [&](const auto&, measurement& m) {
        set_errors(m, differences_from_cpu<myriad::cash_karp>(what, size, how.device));
    })};
}

}  // namespace

benchmark_case keller_miksis_case() {
    return {.name = "keller_miksis",
            .work =
                "64 phases tau in [0, 1] from (1, 0), t and step restarted in each, Cash-Karp, tolerances 1e-10, f1 = "
                "logspace(20 kHz, 1000 kHz, N) at 1.5 bar, power and angles by exp2(y log2 x), sinpi and cospi",
            .error = "difference of 64 instances from the CPU backend after 1 phase, over max(1, |value|)",
            .allowed_error = 1e-7,
            .sizes = {8192, 46080},
            .measure = &measure};
}

}  // namespace gpu_ensembles
