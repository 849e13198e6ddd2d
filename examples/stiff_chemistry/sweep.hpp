// SPDX-License-Identifier: MIT
// The parameter plane of the Oregonator: constants, start, options, and its equilibrium in closed form. Host code.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Core>
#include <myriad/myriad.hpp>

#include "../common/grid.hpp"
#include "oregonator.hpp"

namespace oregonator_sweep {

// Field's constants for the laboratory reaction are q = 8e-4, epsilon = 0.04 and epsilon' = 4e-4.
inline constexpr double q = 8e-4, ratio = 0.01;
inline constexpr double f_first = 0.3, f_last = 2.7, epsilon_first = 2e-3, epsilon_last = 2;
inline constexpr double perturbation = 1e-3;  // relative perturbation of z at the start
inline constexpr double longest_cycle = 100, tolerance = 1e-6, absolute_tolerance = 1e-10, event_tolerance = 1e-9;

/// The only equilibrium with positive concentrations: z = x, y = f x / (q + x), and x^2 - (1 - q - f) x = q (1 + f).
inline Eigen::Vector3d equilibrium(double f) {
    const double b = 1 - q - f, c = 4 * q * (1 + f), root = std::sqrt(b * b + c);
    const double x = b > 0 ? (b + root) / 2 : c / 2 / (root - b);  // without cancellation
    return {x, f * x / (q + x), x};
}

/// Small deviations from equilibrium grow as exp(rate t) and oscillate with the frequency (zero if they do not), by the
/// leading eigenvalue of the Jacobian [a b 0; c d e; 1 0 -1] there.
struct growth {
    double rate, frequency;
};
inline growth growth_at(double f, double epsilon) {
    const Eigen::Vector3d rest = equilibrium(f);
    const double x = rest[0], y = rest[1], slow = ratio * epsilon;
    const double a = (1 - 2 * x - y) / epsilon, b = (q - x) / epsilon, c = -y / slow, d = -(q + x) / slow, e = f / slow;
    // Characteristic polynomial r^3 + p2 r^2 + p1 r + p0. Newton's method descends to its least real root, that of the
    // fast bromide, from the left until rounding stops it.
    const double p2 = 1 - a - d, p1 = a * d - a - d - b * c, p0 = a * d - b * c - b * e;
    double fast = -1 - std::max({std::abs(p2), std::abs(p1), std::abs(p0)});
    for (double last = 2 * fast; fast > last;) {
        last = fast;
        fast -= (((fast + p2) * fast + p1) * fast + p0) / ((3 * fast + 2 * p2) * fast + p1);
    }
    // The remaining factor is r^2 - sum r + product.
    const double product = -p0 / fast, sum = (p1 - product) / fast, square = sum * sum / 4 - product;
    const growth pair{sum / 2 + std::sqrt(std::max(square, 0.0)), std::sqrt(std::max(-square, 0.0))};
    return pair.rate > fast ? pair : growth{fast, 0};
}

/// side x side instances, f along the rows, epsilon with a constant ratio from row to row, all close to equilibrium.
inline myriad::ensemble<oregonator> prepare(std::int64_t side) {
    myriad::ensemble<oregonator> sweep(side * side);
    examples::fill_plane(sweep.parameter(oregonator::f), examples::linspace(f_first, f_last, side),
                         sweep.parameter(oregonator::epsilon), examples::geomspace(epsilon_first, epsilon_last, side));
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        const Eigen::Vector3d start = equilibrium(sweep.parameter(oregonator::f)[i]);
        sweep.state(oregonator::x)[i] = start[0];
        sweep.state(oregonator::y)[i] = start[1];
        sweep.state(oregonator::z)[i] = start[2] * (1 + perturbation);
    }
    sweep.shared(oregonator::q) = q;
    sweep.shared(oregonator::ratio) = ratio;
    sweep.time_domain(0, longest_cycle);
    return sweep;
}

/// Each phase is one cycle, between maxima of z.
inline myriad::options integration(std::int64_t phases) {
    return {.phases = phases,
            .relative_tolerance = tolerance,
            .absolute_tolerance = absolute_tolerance,
            .step = 1e-4,
            .phase_step = myriad::phase_step::carry_on,
            .events = {{.direction = myriad::direction::falling, .tolerance = event_tolerance, .stop_after = 1}}};
}

}  // namespace oregonator_sweep
