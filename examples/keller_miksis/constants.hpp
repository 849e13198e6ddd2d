// SPDX-License-Identifier: MIT
// The constants of the dimensionless Keller-Miksis equation, from a bubble in water and the sound that drives it. Host
// code, SI units. Keller and Miksis, J. Acoust. Soc. Am. 68 (1980) 628-633; the dimensionless form and the properties
// of water at 25 C are those of the MPGOS paper, F. Hegedus, Commun. Nonlinear Sci. Numer. Simul. 97 (2021) 105732.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

namespace bubble {

inline constexpr double vapour_pressure = 3166.775638952003;  // Pa
inline constexpr double density = 997.0639504998557;          // kg/m3
inline constexpr double surface_tension = 0.071977583160056;  // N/m
inline constexpr double viscosity = 8.902125058209557e-4;     // Pa s
inline constexpr double sound_speed = 1497.251785455527;      // m/s
inline constexpr double polytropic_exponent = 1.4;            // of the gas, adiabatic
inline constexpr double ambient_pressure = 1e5;               // Pa
inline constexpr double radius = 10e-6;                       // m, at rest

/// Units of the tables and the command line, and the frequency range of the sweeps.
inline constexpr double kHz = 1e3, bar = 1e5, us = 1e-6;
inline constexpr double f_first = 20 * kHz, f_last = 1000 * kHz;

/// A sound wave: pressure amplitude in Pa, frequency in Hz.
struct sound {
    double pressure, frequency;
};

/// C0 to C12. Unit of length: the radius at rest; unit of time: a period of the first wave. C12, the phase of the
/// second wave, is in half turns, for functions such as `sincospi`.
inline std::array<double, 13> constants(const sound& first, const sound& second) {
    constexpr double excess = ambient_pressure - vapour_pressure + 2 * surface_tension / radius, phase = 0;
    const double omega_1 = 2 * std::numbers::pi * first.frequency, omega_2 = 2 * std::numbers::pi * second.frequency;
    const double q = 2 * std::numbers::pi / (radius * omega_1);
    return {excess * q * q / density,
            (1 - 3 * polytropic_exponent) * excess * q / (density * sound_speed),
            (ambient_pressure - vapour_pressure) * q * q / density,
            2 * surface_tension * q * q / (density * radius),
            4 * viscosity / (density * radius * radius) * 2 * std::numbers::pi / omega_1,
            first.pressure * q * q / density,
            second.pressure * q * q / density,
            radius * omega_1 * first.pressure * q * q / (density * sound_speed),
            radius * omega_2 * second.pressure * q * q / (density * sound_speed),
            radius * omega_1 / (2 * std::numbers::pi * sound_speed),
            3 * polytropic_exponent,
            omega_2 / omega_1,
            phase / std::numbers::pi};
}

/// Frequency of small free oscillations without damping, in Hz; without surface tension, vapour and the viscous term,
/// of 3e-4, it is Minnaert's.
inline double eigenfrequency() {
    const double gas = ambient_pressure - vapour_pressure + 2 * surface_tension / radius;
    const double stiffness = 3 * polytropic_exponent * gas - 2 * surface_tension / radius;
    const double mass = density * radius * radius * (1 + 4 * viscosity / (density * radius * sound_speed));
    return std::sqrt(stiffness / mass) / (2 * std::numbers::pi);
}

}  // namespace bubble
