// SPDX-License-Identifier: MIT
// The sweep of Roessler's equations over c: constants, start and options. Host code.
#pragma once

#include <cstdint>
#include <limits>

#include <myriad/myriad.hpp>

#include "../common/grid.hpp"
#include "roessler.hpp"

namespace roessler_sweep {

inline constexpr double a = 0.1, b = 0.1, c_first = 4, c_last = 20;
inline constexpr double tolerance = 1e-9, section_tolerance = 1e-9;

// snippet: ensemble
inline myriad::ensemble<roessler> prepare(std::int64_t instances, double first = c_first, double last = c_last) {
    myriad::ensemble<roessler> sweep(instances);
    sweep.parameter(roessler::c) = examples::linspace(first, last, instances);
    sweep.shared(roessler::a) = a;
    sweep.shared(roessler::b) = b;
    sweep.state(roessler::x) = -5;
    sweep.state(roessler::y) = 0;
    sweep.state(roessler::z) = 0;
    sweep.time_domain(0, std::numeric_limits<double>::infinity());  // the section ends a phase
    return sweep;
}
// end of snippet

// snippet: options
/// Every phase begins at t = 0, so that its recorded end time is the return time.
inline myriad::options integration(std::int64_t transient, std::int64_t returns) {
    return {.phases = transient + returns,
            .relative_tolerance = tolerance,
            .absolute_tolerance = tolerance,
            .phase_time = myriad::phase_time::restart,
            .phase_step = myriad::phase_step::carry_on,
            .events = {{.direction = myriad::direction::falling, .tolerance = section_tolerance, .stop_after = 1}},
            .record = {.from_phase = transient, .states = {roessler::x, roessler::z}, .time = true}};
}
// end of snippet

}  // namespace roessler_sweep
