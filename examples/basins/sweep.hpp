// SPDX-License-Identifier: MIT
// The pendulum's constants, the barrier between its wells, the grid of initial states and the options. Host code.
#pragma once

#include <cstdint>
#include <limits>
#include <numbers>

#include <myriad/myriad.hpp>

#include "../common/grid.hpp"
#include "magnetic_pendulum.hpp"

namespace basins {

using pendulum = magnetic_pendulum;

inline constexpr double omega = 0.5, damping = 0.2, height = 0.3, extent = 1.5;
inline constexpr double tolerance = 1e-8, natural_period = 2 * std::numbers::pi / omega;

// snippet: barrier
/// The lowest potential on the three rays from the centre away from the magnets, which separate the wells: that of the
/// saddle between two magnets. Along a ray the potential falls from a maximum at the centre and rises after the saddle.
inline double barrier() {
    const auto potential = [](double r) { return pendulum::potential(-r, 0.0, omega, height); };
    double inside = 0, outside = 0.5;
    constexpr double golden = 0.3819660112501051;
    while (outside - inside > 1e-7) {
        const double a = inside + golden * (outside - inside), b = outside - golden * (outside - inside);
        (potential(a) < potential(b) ? outside : inside) = potential(a) < potential(b) ? b : a;
    }
    return potential(inside);
}
// end of snippet
inline constexpr double never = std::numeric_limits<double>::lowest();  // a barrier below any energy

/// The midpoints of the cells along an axis, symmetric about zero to the bit.
inline Eigen::ArrayXd places(std::int64_t cells) {
    const auto n = static_cast<double>(cells);
    return extent * (2 * examples::linspace(0, n - 1, cells) + 1 - n) / n;
}

/// Pendulums at rest at the midpoints of side x side cells, row by row.
inline myriad::ensemble<pendulum> grid(std::int64_t side, double barrier, double duration) {
    myriad::ensemble<pendulum> sweep(side * side);
    const Eigen::ArrayXd axis = places(side);
    examples::fill_plane(sweep.state(pendulum::x), axis, sweep.state(pendulum::y), axis);
    sweep.state(pendulum::u) = 0;
    sweep.state(pendulum::v) = 0;
    sweep.shared(pendulum::omega) = omega;
    sweep.shared(pendulum::damping) = damping;
    sweep.shared(pendulum::height) = height;
    sweep.shared(pendulum::barrier) = barrier;
    sweep.time_domain(0, duration);
    return sweep;
}

/// The nearest magnet, 1 to 3, by the third of the plane in which the bob is.
inline int nearest_magnet(double x, double y) {
    const double along_1 = pendulum::x_1 * x, along_2 = pendulum::x_23 * x + pendulum::half * y,
                 along_3 = pendulum::x_23 * x - pendulum::half * y;
    if (along_1 > along_2 && along_1 > along_3) return 1;
    return along_2 > along_3 ? 2 : 3;
}

inline myriad::options integration() { return {.relative_tolerance = tolerance, .absolute_tolerance = tolerance}; }

}  // namespace basins
