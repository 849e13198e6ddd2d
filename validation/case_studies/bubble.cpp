// SPDX-License-Identifier: MIT
// Keller-Miksis bubbles under one and two waves, from rest over some collapses, against CVODE with root finding and the
// equation in SI units: largest radius, strongest collapse with its duration, and maxima per period. Exit status 0 if
// all agree, else 1.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <iostream>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <myriad/myriad.hpp>

#include "cvode.hpp"
#include "dual_frequency.hpp"

namespace {

using dual_frequency::model, dual_frequency::waves;

constexpr std::int64_t transient = 2, recorded = 6;
/// A shift of the start that moves the solution as far as Cash-Karp's errors may: one or two thousand steps, each with
/// an error of up to 1e-10.
constexpr double displacement = 2e-7;

struct history {
    double largest = 0, compression = 0, collapse_time = 0, winding = 0;
    double earlier = 0;  // by this time the events' tolerance may move the minimum, or the maximum before it
};

/// The Keller-Miksis equation as in textbooks, in SI units and without the model's constants: with M = R'/c, liquid
/// pressure p at the wall and P(t) far away, (1 - M) R R'' + 3/2 (1 - M/3) R'^2 = (1 + M + R/c d/dt) (p - P) / rho, p =
/// pG (RE/R)^(3 gamma) + pV - 2 sigma/R - 4 mu R'/R. Input and output in units of the radius at rest and the period of
/// the first wave.
double acceleration(const waves& w, double tau, const double* u) {
    using namespace bubble;
    const double rate = w.first.frequency, t = tau / rate;
    const double R = radius * u[0], V = radius * rate * u[1], M = V / sound_speed;
    double far = ambient_pressure, far_rate = 0;
    for (const sound& wave : {w.first, w.second}) {
        const double omega = 2 * std::numbers::pi * wave.frequency;
        far += wave.pressure * std::sin(omega * t);
        far_rate += wave.pressure * omega * std::cos(omega * t);
    }
    const double gas = (ambient_pressure - vapour_pressure + 2 * surface_tension / radius) *
                       std::pow(radius / R, 3 * polytropic_exponent);
    const double wall = gas + vapour_pressure - 2 * surface_tension / R - 4 * viscosity * V / R;
    // without its term in R''
    const double wall_rate =
        -3 * polytropic_exponent * gas * V / R + 2 * surface_tension * V / (R * R) + 4 * viscosity * V * V / (R * R);
    const double pressure = (1 + M) * (wall - far) + R / sound_speed * (wall_rate - far_rate);
    const double A =
        (pressure / density - 1.5 * (1 - M / 3) * V * V) / ((1 - M) * R + 4 * viscosity / (density * sound_speed));
    return A / (radius * rate * rate);
}

history follow(const waves& w, double y_start) {
    validation::cvode radius(
        2,
        [&w](double t, const double* u, double* du) {
            du[0] = u[1];
            du[1] = acceleration(w, t, u);
        },
        1e-13, 1e-14);
    radius.watch({-1, 1}, [](double, const double* u, double* g) { g[0] = g[1] = u[1]; });
    radius.start(0, {y_start, 0});

    history h;
    double y_max = y_start, t_max = 0, y_min = y_start, t_min = 0, t_first = 0;
    double unsharp_max = 0, unsharp_min = 0;
    for (std::int64_t phase = 0; phase < transient + recorded;) {
        if (!radius.advance(1e6)) throw std::runtime_error("CVODE finds no further maximum");
        const auto u = radius.state();
        const double bend = std::abs(acceleration(w, radius.t(), u.data()));
        if (radius.found()[0] == 0) {
            y_min = u[0];
            t_min = radius.t();
            unsharp_min = dual_frequency::minimum_tolerance / bend;
            continue;
        }
        if (phase >= transient) {
            if (y_max / y_min > h.compression) {
                h.compression = y_max / y_min;
                h.collapse_time = t_min - t_max;
                h.earlier = unsharp_max + unsharp_min;
            }
            h.largest = std::max({h.largest, y_max, u[0]});
        }
        y_max = y_min = u[0];
        t_max = t_min = radius.t();
        unsharp_max = dual_frequency::maximum_tolerance / bend;
        if (++phase == transient) t_first = t_max;
    }
    h.winding = static_cast<double>(recorded) / (t_max - t_first);
    return h;
}

std::vector<waves> choose() {
    std::vector<waves> all;
    constexpr std::array<std::array<double, 2>, 4> pressures{{{0.5e5, 0.7e5}, {1.1e5, 1.2e5}, {0.8e5, 0}, {1.5e5, 0}}};
    for (const auto& p : pressures)
        for (const double f1 : {20e3, 70e3, 250e3, 900e3})
            for (const double f2 : {30e3, 330e3, 800e3})
                if (p[1] > 0 || f2 == 30e3) all.push_back({{p[0], f1}, {p[1], f2}});
    return all;
}

int compare() {
    const auto chosen = choose();
    auto sweep = dual_frequency::prepare(chosen, transient);
    const auto report = myriad::solve<myriad::cash_karp>(myriad::device::cpu(), sweep,
                                                         dual_frequency::integration(transient + recorded));
    std::cout << report;
    std::int64_t wrong = 0, sensitive = 0;
    double strongest = 0, worst = 0;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        const auto n = static_cast<std::int64_t>(i);
        const history exact = follow(chosen[i], 1), moved = follow(chosen[i], 1 + displacement);
        const auto differs = [&](const char* what, double is, double expected, double elsewhere, double unsharp) {
            // In both directions, as the maximum over collapses may switch to another one on one side only.
            const double allowed = 2 * std::abs(elsewhere - expected) + displacement * std::abs(expected) + unsharp;
            worst = std::max(worst, std::abs(is - expected) / allowed);
            if (std::abs(is - expected) <= allowed) return false;
            std::cout << "instance " << i << ": " << what << " is " << is << ", with CVODE " << expected << ", allowed "
                      << allowed << '\n';
            return true;
        };
        if (std::abs(moved.compression / exact.compression - 1) > 1e-2) {
            ++sensitive;
            continue;
        }
        strongest = std::max(strongest, exact.compression);
        const double period = static_cast<double>(recorded) / exact.winding;
        const bool bad =
            differs("largest radius", sweep.accessory(model::largest)[n], exact.largest, moved.largest, 0) +
            differs("compression", sweep.accessory(model::compression)[n], exact.compression, moved.compression, 0) +
            differs("collapse time", sweep.accessory(model::collapse_time)[n], exact.collapse_time, moved.collapse_time,
                    exact.earlier) +
            differs("winding number", sweep.accessory(model::winding)[n], exact.winding, moved.winding,
                    2 * exact.earlier / period * exact.winding);
        wrong += bad;
    }
    std::cout << chosen.size() << " bubbles, strongest compression " << strongest << ", " << sensitive
              << " too sensitive to compare, " << wrong << " differ; largest difference " << worst
              << " of what is allowed\n";
    // a comparison of gentle or of few oscillations would prove little
    const bool meaningful = strongest > 20 && 4 * sensitive <= static_cast<std::int64_t>(chosen.size());
    return wrong == 0 && report.failed() == 0 && meaningful ? 0 : 1;
}

}  // namespace

int main() {
    try {
        const int status = compare();
        std::cout << (status == 0 ? "All checks passed.\n" : "A check FAILED.\n");
        return status;
    } catch (const std::exception& e) {
        std::cerr << e.what() << '\n';
        return 2;
    }
}
