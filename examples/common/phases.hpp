// SPDX-License-Identifier: MIT
// Options for phases without events.
#pragma once

#include <cstdint>

#include "myriad/options.hpp"

namespace examples {

/// Phases of a smooth motion: each begins with the step size that the previous one would have tried next.
inline myriad::options smooth_phases(std::int64_t phases, double tolerance) {
    return {.phases = phases,
            .relative_tolerance = tolerance,
            .absolute_tolerance = tolerance,
            .phase_step = myriad::phase_step::carry_on};
}

}  // namespace examples
