// SPDX-License-Identifier: MIT
// Bubbles under two waves: the ensemble and its integration. Host code.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <myriad/myriad.hpp>

#include "constants.hpp"
#include "keller_miksis.hpp"

namespace dual_frequency {

using model = bubble_dual_frequency;

/// Error of the radius due to the event tolerances: 1e-12 / (2 y'') at maxima, 1e-6 / (2 y'') at minima, where y'' is
/// large.
inline constexpr double tolerance = 1e-10, maximum_tolerance = 1e-6, minimum_tolerance = 1e-3;

/// The sound of one instance.
struct waves {
    bubble::sound first, second;
};

inline myriad::ensemble<model> prepare(const std::vector<waves>& driven_by, std::int64_t transient) {
    myriad::ensemble<model> sweep(static_cast<std::int64_t>(driven_by.size()));
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        const waves& w = driven_by[static_cast<std::size_t>(i)];
        const auto C = bubble::constants(w.first, w.second);
        static_assert(C.size() == model::n_parameter);
        for (int c = 0; c < model::n_parameter; ++c) sweep.parameter(c)[i] = C[static_cast<std::size_t>(c)];
    }
    sweep.shared_integer(model::transient_phases) = static_cast<std::int32_t>(transient);
    sweep.state(model::y) = 1;
    sweep.state(model::v) = 0;
    sweep.time_domain(0, std::numeric_limits<double>::infinity());  // the maximum ends a phase
    return sweep;
}

inline myriad::options integration(std::int64_t phases) {
    // snippet: options
    return {.phases = phases,
            .relative_tolerance = tolerance,
            .absolute_tolerance = tolerance,
            .step = 1e-2,
            .minimum_step = 1e-12,
            .phase_time = myriad::phase_time::carry_on,
            .phase_step = myriad::phase_step::carry_on,
            .events = {{.direction = myriad::direction::falling, .tolerance = maximum_tolerance, .stop_after = 1},
                       {.direction = myriad::direction::rising, .tolerance = minimum_tolerance}}};
    // end of snippet
}

}  // namespace dual_frequency
