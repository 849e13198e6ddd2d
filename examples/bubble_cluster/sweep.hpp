// SPDX-License-Identifier: MIT
// The clusters of MPGOS's tutorial: 128 bubbles of random sizes at random places, under sound of 600 pressures. Host
// code.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <Eigen/Core>
#include <myriad/myriad.hpp>
#include <myriad/random.hpp>

#include "../keller_miksis/constants.hpp"
#include "cluster.hpp"

namespace cluster_sweep {

inline constexpr double frequency = 1000 * bubble::kHz, pressure_first = 0, pressure_last = 5 * bubble::bar;
inline constexpr double radius_least = 3e-6, radius_most = 8e-6;  // m, evenly distributed
inline constexpr double spread = 10e-3;                           // m, of the normal distribution of each coordinate
inline constexpr double tolerance = 1e-10;
inline constexpr std::uint64_t seed = 128;

struct bubbles {
    Eigen::ArrayXd radius;      ///< at rest, m
    Eigen::ArrayX3d position;   ///< m
    Eigen::MatrixXd influence;  ///< of the bubble of the column on that of the row
};

// snippet: bubbles
/// The same cluster every time, as random numbers depend on the seed and the number of the bubble alone.
inline bubbles draw_bubbles() {
    constexpr int n = bubble_cluster::n_unit;
    bubbles b{Eigen::ArrayXd(n), Eigen::ArrayX3d(n, 3), Eigen::MatrixXd::Zero(n, n)};
    for (int i = 0; i < n; ++i) {
        myriad::random_numbers<double> random(seed, i, 0);
        b.radius[i] = random.uniform(radius_least, radius_most);
        for (int axis = 0; axis < 3; ++axis) b.position(i, axis) = random.normal(0, spread);
    }
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            if (i != j)
                b.influence(i, j) = std::pow(b.radius[j], 3) / std::pow(b.radius[i], 2) /
                                    (b.position.row(i) - b.position.row(j)).matrix().norm();
    return b;
}
// end of snippet

/// C0 to C9 of one bubble, those of the sound per pascal of its amplitude: the constants of examples/keller_miksis for
/// bubbles of other sizes; and the exponent of its gas.
inline std::array<double, cluster_bubble::n_unit_shared> constants_of(double radius) {
    using namespace bubble;
    const double gas = ambient_pressure - vapour_pressure + 2 * surface_tension / radius;
    const double q = 1 / (radius * frequency);  // s/m: the unit of time over that of length
    return {gas * q * q / density,
            (1 - 3 * polytropic_exponent) * gas * q / (density * sound_speed),
            (ambient_pressure - vapour_pressure) * q * q / density,
            2 * surface_tension * q * q / (density * radius),
            4 * viscosity / (density * radius * radius * frequency),
            q * q / density,
            2 * std::numbers::pi * radius * frequency * q * q / (density * sound_speed),
            radius * frequency / sound_speed,
            3 * polytropic_exponent};
}

/// One instance for each pressure; all bubbles start at rest, and a phase is a period of the sound.
inline myriad::ensemble<bubble_cluster> prepare(const bubbles& b, const Eigen::ArrayXd& pressures) {
    myriad::ensemble<bubble_cluster> sweep(pressures.size());
    sweep.parameter(cluster_bubble::pressure) = pressures;
    for (int i = 0; i < bubble_cluster::n_unit; ++i) {
        const auto c = constants_of(b.radius[i]);
        for (int k = 0; k < cluster_bubble::n_unit_shared; ++k)
            sweep.shared(bubble_cluster::shared_of(i, k)) = c[static_cast<std::size_t>(k)];
        sweep.state(bubble_cluster::state_of(i, cluster_bubble::y)) = 1;
        sweep.state(bubble_cluster::state_of(i, cluster_bubble::v)) = 0;
    }
    myriad::set_coupling(sweep, 0, b.influence);
    sweep.time_domain(0, 1);
    return sweep;
}

inline myriad::options settings(std::int64_t phases) {
    return {.phases = phases,
            .relative_tolerance = tolerance,
            .absolute_tolerance = tolerance,
            .step = 1e-3,
            .minimum_step = 1e-13,
            .phase_step = myriad::phase_step::carry_on};
}

}  // namespace cluster_sweep
