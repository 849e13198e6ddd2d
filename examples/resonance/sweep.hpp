// SPDX-License-Identifier: MIT
// The sweep over frequency, hardening and start, and its response by hooks and by dense output. Host code.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <myriad/myriad.hpp>

#include "../common/grid.hpp"
#include "oscillator.hpp"

namespace resonance {

inline constexpr double zeta = 0.05, omega_first = 0.5, omega_last = 1.6;
inline constexpr std::array betas = {0.0, 0.002, 0.01};
inline constexpr std::int64_t starts = 2;  // at rest; on the backbone curve, which leads to the upper of two branches
inline constexpr std::int64_t curves = starts * static_cast<std::int64_t>(betas.size());
inline constexpr double tolerance = 1e-10, event_tolerance = 1e-8;
inline constexpr std::int64_t samples_per_phase = 200;

/// The velocity at x = 0 of a free oscillation with that frequency, by harmonic balance: omega^2 = 1 + 3/4 beta A^2.
inline double backbone_velocity(double omega, double beta) {
    return beta > 0 && omega > 1 ? omega * std::sqrt((omega * omega - 1) / (0.75 * beta)) : 0;
}

/// Instance i: frequency i mod n, then the start, then the hardening. One phase is a period of the forcing.
template <class Model>
myriad::ensemble<Model> prepare(std::int64_t n) {
    myriad::ensemble<Model> sweep(curves * n);
    sweep.shared(Model::zeta) = zeta;
    sweep.state(Model::x) = 0;
    sweep.t_begin() = 0;
    const Eigen::ArrayXd frequencies = examples::linspace(omega_first, omega_last, n);
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        const double beta = betas[static_cast<std::size_t>(i / (starts * n))], omega = frequencies[i % n];
        sweep.parameter(Model::omega)[i] = omega;
        sweep.parameter(Model::beta)[i] = beta;
        sweep.state(Model::v)[i] = i / n % starts == 0 ? 0 : backbone_velocity(omega, beta);
        sweep.t_end()[i] = 2 * std::numbers::pi / omega;
    }
    return sweep;
}

/// Resets the maximum, the minimum and the integral to the current state.
inline void begin_response(myriad::ensemble<response>& sweep) {
    // snippet: begin
    sweep.accessory(response::maximum) = sweep.state(response::x);
    sweep.accessory(response::minimum) = sweep.state(response::x);
    sweep.accessory(response::integral) = 0;
    sweep.accessory(response::x_before) = sweep.state(response::x);
    sweep.accessory(response::v_before) = sweep.state(response::v);
    // end of snippet
}

/// Largest, smallest and mean square x of each instance, one row each, from the samples of whole periods.
inline Eigen::Array<double, Eigen::Dynamic, 3> evaluate(const myriad::ensemble<oscillator>& sweep) {
    Eigen::Array<double, Eigen::Dynamic, 3> found(sweep.size(), 3);
    // snippet: evaluate
    const auto t = sweep.samples().time(), x = sweep.samples().state(oscillator::x);
    found.col(0) = x.rowwise().maxCoeff();
    found.col(1) = x.rowwise().minCoeff();
    found.col(2) = 0;
    for (Eigen::Index s = 1; s < x.cols(); ++s) {
        // Time restarts in every phase, so that its first sample has no interval before it.
        const auto interval = (t.col(s) - t.col(s - 1)).max(0);
        found.col(2) += 0.5 * interval * (x.col(s - 1).square() + x.col(s).square());
    }
    // end of snippet
    return found;
}

}  // namespace resonance
