// SPDX-License-Identifier: MIT
// Clusters of bubbles against CVODE, by the equations in SI units as they stand in the literature: radii and velocities
// after a period of the sound. Exit status 0 if all agree, else 1.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <numbers>
#include <vector>

#include "cvode.hpp"
#include "sweep.hpp"

namespace {

using namespace cluster_sweep;
constexpr int n = bubble_cluster::n_unit;

/// Radii in m and velocities in m/s at the time t, from rest. Keller and Miksis, with s = R' / c:
/// (1 - s) R R'' + 3/2 (1 - s/3) R'^2 = (1 + s + R/c d/dt) (p_gas - p_inf(t)) / rho - sum_j (2 R_j R_j'^2 + R_j^2
/// R_j'') / d, where R_j'' is that of bubble j alone, as in the model.
std::vector<double> by_cvode(const bubbles& b, double pressure, double t_end) {
    using namespace bubble;
    const double omega = 2 * std::numbers::pi * frequency;
    // radii and velocities of the reference are of the order of one, in the units of the model
    validation::cvode solution(
        2 * n,
        [&](double time, const double* u, double* du) {
            const double t = time / frequency;
            std::vector<double> alone(n), over(n);
            for (int i = 0; i < n; ++i) {
                const double rest = b.radius[i], R = u[2 * i] * rest, V = u[2 * i + 1] * rest * frequency;
                const double s = V / sound_speed;
                const double gas_at_rest = ambient_pressure - vapour_pressure + 2 * surface_tension / rest;
                const double gas = gas_at_rest * std::pow(rest / R, 3 * polytropic_exponent);
                const double p = gas + vapour_pressure - 2 * surface_tension / R - 4 * viscosity * V / R -
                                 ambient_pressure - pressure * std::sin(omega * t);
                // d/dt of p without the part with R'', which is 4 viscosity R'' / R
                const double dp = -3 * polytropic_exponent * gas * V / R + 2 * surface_tension * V / (R * R) +
                                  4 * viscosity * V * V / (R * R) - pressure * omega * std::cos(omega * t);
                const double right =
                    (1 + s) * p / density + R * dp / (density * sound_speed) - 1.5 * (1 - s / 3) * V * V;
                const double left = (1 - s) * R + 4 * viscosity / (density * sound_speed);
                alone[static_cast<std::size_t>(i)] = right / left;
                over[static_cast<std::size_t>(i)] = 1 / left;
            }
            for (int i = 0; i < n; ++i) {
                double sum = 0;
                for (int j = 0; j < n; ++j) {
                    if (j == i) continue;
                    const double R = u[2 * j] * b.radius[j], V = u[2 * j + 1] * b.radius[j] * frequency;
                    sum += (2 * R * V * V + R * R * alone[static_cast<std::size_t>(j)]) /
                           (b.position.row(i) - b.position.row(j)).matrix().norm();
                }
                const auto k = static_cast<std::size_t>(i);
                du[2 * i] = u[2 * i + 1];
                du[2 * i + 1] = (alone[k] - over[k] * sum) / (b.radius[i] * frequency * frequency);
            }
        },
        1e-12, 1e-12);
    std::vector<double> start(2 * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) start[2 * i] = 1;
    solution.start(0, start);
    solution.advance(t_end);
    return solution.state();
}

}  // namespace

int main() {
    const bubbles b = draw_bubbles();
    Eigen::ArrayXd pressures(3);
    pressures << 0.3, 0.8, 1.5;
    pressures *= bubble::bar;
    auto sweep = prepare(b, pressures);
    myriad::solve<myriad::cash_karp>(myriad::device::parse("cpu"), sweep, settings(1));
    // Errors of a step, 1e-10, at some hundred steps. Without the other bubbles radii would differ by more than 1e-3.
    constexpr double allowed = 1e-8;
    double worst = 0, moved = 0;
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        const auto expected = by_cvode(b, pressures[i], 1);
        for (int c = 0; c < 2 * n; ++c) {
            const double of = expected[static_cast<std::size_t>(c)];
            const double error = std::abs(sweep.state(c)[i] - of) / (1 + std::abs(of));
            worst = std::isnan(error) ? 1 : std::max(worst, error);
            if (c % 2 == 0) moved = std::max(moved, std::abs(of - 1));
        }
    }
    std::cout << sweep.size() << " clusters after a period: radii and velocities within " << worst
              << " of CVODE; radii change by up to " << moved << '\n';
    return worst < allowed && moved > 0.2 ? 0 : 1;
}
