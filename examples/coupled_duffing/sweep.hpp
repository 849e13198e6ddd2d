// SPDX-License-Identifier: MIT
// The rings of MPGOS's tutorial: constants, and starts of one oscillator that differs from the others. Host code.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include <myriad/myriad.hpp>

#include "ring.hpp"

namespace ring_sweep {

inline constexpr double damping = 0.24, amplitude = 13.633, frequency = 0.5, strength = 0.004;
inline constexpr double period = 2 * std::numbers::pi / frequency;
inline constexpr double tolerance = 1e-8;
inline constexpr double start = -5;  ///< of x and of v of all oscillators but one
inline constexpr int odd_one = 11;
inline constexpr double x_first = -8, x_last = 8, v_first = -20, v_last = 40;  ///< of that one

/// One instance for each start of the odd one, on a square grid of at least `instances`; a phase is a period.
inline myriad::ensemble<ring> prepare(std::int64_t instances) {
    const auto side = static_cast<std::int64_t>(std::ceil(std::sqrt(static_cast<double>(instances)) - 1e-9));
    const Eigen::ArrayXd x = Eigen::ArrayXd::LinSpaced(side, x_first, x_last),
                         v = Eigen::ArrayXd::LinSpaced(side, v_first, v_last);
    // snippet: ensemble
    myriad::ensemble<ring> sweep(instances);
    Eigen::MatrixXd neighbours = Eigen::MatrixXd::Zero(ring::n_unit, ring::n_unit);
    for (int i = 0; i < ring::n_unit; ++i) {
        const int next = (i + 1) % ring::n_unit;
        neighbours(i, next) = neighbours(next, i) = strength / 2;
        sweep.state(ring::state_of(i, oscillator::x)) = start;
        sweep.state(ring::state_of(i, oscillator::v)) = start;
    }
    myriad::set_coupling(sweep, oscillator::positions, neighbours);
    myriad::set_coupling(sweep, oscillator::velocities, neighbours);
    // end of snippet
    for (std::int64_t i = 0; i < instances; ++i) {
        sweep.state(ring::state_of(odd_one, oscillator::x))[i] = x[i / side];
        sweep.state(ring::state_of(odd_one, oscillator::v))[i] = v[i % side];
    }
    sweep.shared(oscillator::damping) = damping;
    sweep.shared(oscillator::amplitude) = amplitude;
    sweep.shared(oscillator::frequency) = frequency;
    sweep.shared(oscillator::strength) = strength;
    sweep.time_domain(0, period);
    return sweep;
}

inline myriad::options settings(std::int64_t phases) {
    myriad::options o{.phases = phases, .relative_tolerance = tolerance, .absolute_tolerance = tolerance, .step = 1e-2};
    // Local maxima: v falls through zero.
    o.events.assign(ring::n_event, {.direction = myriad::direction::falling, .tolerance = 1e-6});
    return o;
}

}  // namespace ring_sweep
