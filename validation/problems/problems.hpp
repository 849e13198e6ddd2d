// SPDX-License-Identifier: MIT
// All validation problems: one function each, and one line in `all_problems`.
#pragma once

#include <vector>

#include "../problem.hpp"

namespace validation {

problem lorenz_problem();
problem duffing_problem();
problem van_der_pol_problem();
problem keller_miksis_problem();
problem relief_valve_problem();
problem bouncing_ball_problem();
problem heat_problem();
problem kepler_problem();
problem timed_circle_problem();
problem robertson_problem();
problem oregonator_problem();
problem pollution_problem();
problem hires_problem();
problem ring_modulator_problem();
problem ring_of_48_problem();

inline std::vector<problem> all_problems() {
    return {lorenz_problem(),       duffing_problem(),        van_der_pol_problem(), keller_miksis_problem(),
            relief_valve_problem(), bouncing_ball_problem(),  heat_problem(),        kepler_problem(),
            timed_circle_problem(), robertson_problem(),      oregonator_problem(),  pollution_problem(),
            hires_problem(),        ring_modulator_problem(), ring_of_48_problem()};
}

/// A solution known only at the end and only for one instance.
inline solution known_end(bool is_that_one, std::vector<double> end) {
    solution s;
    if (!is_that_one)
        for (double& y : end) y = unknown;
    s.end = std::move(end);
    return s;
}

}  // namespace validation
