// SPDX-License-Identifier: MIT
// The relief valve by CVODE: root finding, and a new start after every impact.
#pragma once

#include <vector>

/// Per completed phase: impacts from the start to its end, and the state there.
struct valve_history {
    std::vector<int> impacts;
    std::vector<std::vector<double>> state;
    bool accumulated = false;  // impacts became too slow to follow; earlier phases are complete
};

/// Follows the valve over so many phases, or until its maxima stop or its impacts accumulate. `seat`: displacement at
/// which it is reflected, to see the effect of a shift.
valve_history follow_valve(double q, int phases, double seat);
