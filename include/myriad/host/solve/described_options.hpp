// SPDX-License-Identifier: MIT
// The options in the form that kernels take. Host code only, free of Eigen.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/methods/controller_policies.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// The properties of a method that a kernel's arguments depend on.
struct method_traits {
    bool adaptive;
    int embedded_order;
    bool scales_tolerances;
};
template <class Method>
inline constexpr method_traits traits_of = {
    .adaptive = Method::embedded_order > 0,
    .embedded_order = Method::embedded_order,
    .scales_tolerances = scales_tolerances<Method>,
};

/// The options in the form that a kernel of the method takes, in its arguments: `kernel_arguments`, or others with the
/// same members, for so many states and events.
template <class R, class Arguments>
void describe_options(Arguments& a, int n_state, int n_event, const options& o, const method_traits& method) {
    a.phases = static_cast<std::int32_t>(o.phases);
    a.phase_length = static_cast<R>(o.phase_length);
    a.phases_per_time = o.phase_length > 0 ? R(1) / a.phase_length : R(0);
    a.carry_time = o.phase_time == phase_time::carry_on || o.phase_length > 0;
    a.carry_step = o.phase_step == phase_step::carry_on;
    a.max_steps = static_cast<std::int32_t>(o.max_steps);
    a.step = static_cast<R>(std::isnan(o.step) ? 1e-2 : o.step);
    a.minimum_step = static_cast<R>(o.minimum_step);
    a.maximum_step = static_cast<R>(o.maximum_step);
    if (method.adaptive) a.step = std::clamp(a.step, a.minimum_step, a.maximum_step);
    a.growth_limit = static_cast<float>(o.growth_limit);
    a.shrink_limit = static_cast<float>(o.shrink_limit);
    for (std::size_t c = 0; c < static_cast<std::size_t>(n_state); ++c) {
        a.relative_tolerance[c] = std::max(static_cast<R>(o.relative_tolerance[c]), least_relative_tolerance<R>);
        // not subnormal: a GPU takes its reciprocal
        a.absolute_tolerance[c] = std::max(static_cast<R>(o.absolute_tolerance[c]), std::numeric_limits<R>::min());
    }
    // What an error of the smallest tolerance per step allows, and a little less, as in MATLAB's ode45.
    if (method.adaptive && std::isnan(o.step)) {
        const R least = *std::min_element(a.relative_tolerance, a.relative_tolerance + n_state);
        a.first_change = R(2) * std::pow(least, R(1) / static_cast<R>(method.embedded_order + 1));
    }
    for (std::size_t j = 0; j < static_cast<std::size_t>(n_event); ++j) {
        const event_options e = o.events.empty() ? event_options{} : o.events[j];
        a.event[j] = {static_cast<R>(e.tolerance), static_cast<std::int32_t>(e.stop_after)};
        const auto asks_for = [&](direction d) { return e.direction == d || e.direction == direction::either; };
        if (asks_for(direction::rising)) a.rising[j / 32] |= std::uint32_t{1} << (j % 32);
        if (asks_for(direction::falling)) a.falling[j / 32] |= std::uint32_t{1} << (j % 32);
    }
    a.sub_samples = static_cast<std::int32_t>(o.sub_samples);
    a.accumulation_limit = static_cast<std::int32_t>(o.accumulation_limit);
}

}  // namespace myriad::host::inline MYRIAD_ABI
