// SPDX-License-Identifier: MIT
// The kernels of teams, simulated.
#define MYRIAD_SIMULATED_TEAM 1
#include "tests/kernel/model/delayed_teams.hpp"
#include "tests/kernel/model/simulated_team.hpp"

INTEGRATE_IN_TEAMS(delayed_teams::phases, myriad::tsitouras_5, 8)
INTEGRATE_IN_TEAMS(delayed_teams::phases, myriad::runge_kutta_4, 4)
INTEGRATE_IN_TEAMS(delayed_teams::pairs, myriad::dormand_prince_5, 4)
INTEGRATE_IN_TEAMS(delayed_teams::cells, myriad::dormand_prince_5, 4)
INTEGRATE_IN_TEAMS(delayed_teams::echoes, myriad::cash_karp, 4)
INTEGRATE_IN_TEAMS(delayed_teams::echoes, myriad::runge_kutta_4, 8)
