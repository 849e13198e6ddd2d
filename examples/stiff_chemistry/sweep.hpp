// SPDX-License-Identifier: MIT
// The plane of parameters of the Oregonator: constants, start, options, and its equilibrium in closed form. Host code.
#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Eigenvalues>
#include <myriad/myriad.hpp>

#include "../common/grid.hpp"
#include "oregonator.hpp"

namespace oregonator_sweep {

// Field's constants for the reaction in the laboratory are q = 8e-4, epsilon = 0.04 and epsilon' = 4e-4.
inline constexpr double q = 8e-4, ratio = 0.01;
inline constexpr double f_first = 0.3, f_last = 2.7, epsilon_first = 2e-3, epsilon_last = 2;
inline constexpr double perturbation = 1e-3;  // of z at the start, relative
inline constexpr double longest_cycle = 100, tolerance = 1e-6, absolute_tolerance = 1e-10, event_tolerance = 1e-9;

/// The only equilibrium with positive concentrations: z = x, y = f x / (q + x), and x^2 - (1 - q - f) x = q (1 + f).
inline Eigen::Vector3d equilibrium(double f) {
    const double b = 1 - q - f, c = 4 * q * (1 + f), root = std::sqrt(b * b + c);
    const double x = b > 0 ? (b + root) / 2 : c / 2 / (root - b);  // without cancellation
    return {x, f * x / (q + x), x};
}

/// Small deviations from equilibrium grow as exp(rate t) and turn with the frequency (zero if they do not turn), by the
/// leading eigenvalue of the Jacobian there.
struct growth {
    double rate, frequency;
};
inline growth growth_at(double f, double epsilon) {
    const Eigen::Vector3d c = equilibrium(f);
    const double x = c[0], y = c[1], slow = ratio * epsilon;
    Eigen::Matrix3d jacobian;
    jacobian << (1 - 2 * x - y) / epsilon, (q - x) / epsilon, 0,  //
        -y / slow, -(q + x) / slow, f / slow,                     //
        1, 0, -1;
    const Eigen::Vector3cd values = jacobian.eigenvalues();
    Eigen::Index leading = 0;
    values.real().maxCoeff(&leading);
    return {values[leading].real(), std::abs(values[leading].imag())};
}

/// side x side instances, f along the rows, epsilon with a constant ratio from row to row, all near their equilibrium.
inline myriad::ensemble<oregonator> prepare(std::int64_t side) {
    myriad::ensemble<oregonator> sweep(side * side);
    const Eigen::ArrayXd f = examples::linspace(f_first, f_last, side),
                         epsilon = examples::logspace(epsilon_first, epsilon_last, side);
    sweep.parameter(oregonator::f) = f.replicate(side, 1);
    for (std::int64_t row = 0; row < side; ++row)
        sweep.parameter(oregonator::epsilon).segment(row * side, side) = epsilon[row];
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

/// Each phase is a cycle, from one maximum of z to the next.
inline myriad::options integration(std::int64_t phases) {
    return {.phases = phases,
            .relative_tolerance = tolerance,
            .absolute_tolerance = absolute_tolerance,
            .step = 1e-4,
            .phase_step = myriad::phase_step::carry_on,
            .events = {{.direction = myriad::direction::falling, .tolerance = event_tolerance, .stop_after = 1}}};
}

}  // namespace oregonator_sweep
