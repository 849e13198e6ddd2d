// SPDX-License-Identifier: MIT
// The relief valve by CVODE.
#include "oracle.hpp"

#include <algorithm>
#include <cmath>

#include "cvode.hpp"
#include "sweep.hpp"

valve_history follow_valve(double q, int phases, double seat) {
    using namespace relief_valve_sweep;
    constexpr double longest_phase = 100;    // dozens of oscillations: no further maximum follows
    constexpr double slowest_impact = 1e-5;  // flights of 2e-6 and heights of 1e-11 at a deceleration of ten
    validation::cvode valve(
        3,
        [q](double, const double* s, double* ds) {
            ds[0] = s[1];
            ds[1] = s[2] - kappa * s[1] - (s[0] + delta);
            ds[2] = beta * (q - s[0] * std::sqrt(std::max(s[2], 0.0)));
        },
        1e-12, 1e-13);
    valve.watch({-1, -1}, [seat](double, const double* s, double* g) {
        g[relief_valve::section] = s[1];
        g[relief_valve::seat] = s[0] - seat;
    });
    valve.start(0, {0.2, 0, 0});

    valve_history history;
    int impacts = 0;
    double t_end = longest_phase;
    while (static_cast<int>(history.impacts.size()) < phases) {
        if (!valve.advance(t_end)) break;
        const auto found = valve.found();
        auto s = valve.state();
        if (found[relief_valve::seat] != 0) {
            ++impacts;
            if (std::abs(s[1]) < slowest_impact) {
                history.accumulated = true;
                break;
            }
            valve.start(valve.t(), {seat, -restitution * s[1], s[2]});
        } else {
            history.impacts.push_back(impacts);
            history.state.push_back(s);
            t_end = valve.t() + longest_phase;
        }
    }
    return history;
}
