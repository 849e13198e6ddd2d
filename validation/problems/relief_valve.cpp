// SPDX-License-Identifier: MIT
// Pressure relief valves with impacts, for a time in which no impacts accumulate.
#include "relief_valve.hpp"

#include "../runner.hpp"
#include "problems.hpp"

namespace validation {

problem relief_valve_problem() {
    problem p;
    p.name = "relief_valve";
    p.what = "Pressure relief valves from (1, 0, 10) to t = 8; flow q from 3 to 9; impacts on the seat and maxima";
    for (const double q : spread(3, 9, 64)) p.instances.push_back({{1, 0, 10}, {q}, 8});
    p.shared = {1.25, 10, 20, 0.8};
    p.events = {{.direction = myriad::direction::falling, .tolerance = 1e-11},
                {.direction = myriad::direction::falling, .tolerance = 1e-11}};
    p.event_times = {relief_valve::t_maximum, relief_valve::t_impact};
    p.events_per_instance = 10;
    p.sampled = {relief_valve::y};
    p.fixed_step = 0.002;
    complete<relief_valve>(p);
    return p;
}

}  // namespace validation
