// SPDX-License-Identifier: MIT
// The plane of damping and forcing: its bounds, the start and the tolerance. Host code.
#pragma once

#include <cstdint>
#include <numbers>

#include <myriad/myriad.hpp>

#include "forced_duffing.hpp"

namespace lyapunov_map {

inline constexpr double k_first = 0.1, k_last = 0.5, B_first = 0, B_last = 0.8;
inline constexpr double x_start = 1, v_start = 0.1;
inline constexpr double tolerance = 1e-9, period = 2 * std::numbers::pi;

/// Forcing and initial state of all instances, one period per phase; the caller sets the parameters.
template <class Model>
myriad::ensemble<Model> start(std::int64_t instances) {
    myriad::ensemble<Model> sweep(instances);
    sweep.state(Model::x) = x_start;
    sweep.state(Model::v) = v_start;
    sweep.time_domain(0, period);
    return sweep;
}

/// Linearised by hand, with the initial tangents of the library.
inline myriad::ensemble<hand_tangent> by_hand(const myriad::ensemble<library_tangent>& same, std::int64_t transient) {
    auto sweep = start<hand_tangent>(same.size());
    sweep.parameter(hand_tangent::k) = same.parameter(forced_duffing::k);
    sweep.parameter(hand_tangent::B) = same.parameter(forced_duffing::B);
    sweep.state(hand_tangent::a) = same.state(library_tangent::tangent(forced_duffing::x));
    sweep.state(hand_tangent::b) = same.state(library_tangent::tangent(forced_duffing::v));
    sweep.shared_integer(hand_tangent::transient) = static_cast<std::int32_t>(transient);
    sweep.accessory(hand_tangent::growth) = 0;
    return sweep;
}

inline myriad::ensemble<library_tangent> by_library(std::int64_t instances, std::int64_t transient) {
    auto sweep = start<library_tangent>(instances);
    myriad::initial_tangents(sweep);
    sweep.shared_integer(library_tangent::transient_phases) = static_cast<std::int32_t>(transient);
    return sweep;
}

}  // namespace lyapunov_map
