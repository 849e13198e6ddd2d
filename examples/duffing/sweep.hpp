// SPDX-License-Identifier: MIT
// The sweep of the Duffing oscillator over its damping, as in the MPGOS paper: constants, grid and start. Host code.
#pragma once

#include <cstdint>
#include <numbers>

#include <myriad/myriad.hpp>

#include "../common/grid.hpp"
#include "duffing.hpp"

namespace duffing_sweep {

inline constexpr double k_first = 0.2, k_last = 0.3, forcing = 0.3;
inline constexpr double x_start = -0.5, v_start = -0.1;
inline constexpr double tolerance = 1e-9, event_tolerance = 1e-6;

inline Eigen::ArrayXd k_grid(std::int64_t instances) { return examples::linspace(k_first, k_last, instances); }

/// One instance per damping; a phase is one period of the forcing.
inline myriad::ensemble<duffing> prepare(const Eigen::ArrayXd& k) {
    myriad::ensemble<duffing> sweep(k.size());
    sweep.parameter(duffing::k) = k;
    sweep.shared(duffing::B) = forcing;
    sweep.state(duffing::x) = x_start;
    sweep.state(duffing::v) = v_start;
    sweep.time_domain(0, 2 * std::numbers::pi);
    for (int c = 0; c < duffing::n_accessory; ++c) sweep.accessory(c) = 0.0;  // `initialise` sets them in every phase
    return sweep;
}

}  // namespace duffing_sweep
