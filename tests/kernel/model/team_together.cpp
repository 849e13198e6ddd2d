// SPDX-License-Identifier: MIT
// The kernels of teams, simulated.
#define MYRIAD_SIMULATED_TEAM 1
#include "tests/kernel/model/simulated_team.hpp"
#include "tests/kernel/model/teams.hpp"

INTEGRATE_IN_TEAMS(teams::places, teams::with_memory, 4)
INTEGRATE_IN_TEAMS(teams::places, teams::with_memory, 16)
INTEGRATE_IN_TEAMS(teams::places, myriad::dormand_prince_8, 64)
INTEGRATE_IN_TEAMS(teams::places, myriad::runge_kutta_4, 8)
INTEGRATE_IN_TEAMS(teams::phases, myriad::cash_karp, 2)
INTEGRATE_IN_TEAMS(teams::phases, myriad::cash_karp, 16)
INTEGRATE_IN_TEAMS(teams::ring, teams::careful_start, 8)
INTEGRATE_IN_TEAMS(teams::places, teams::sampled, 4)
INTEGRATE_IN_TEAMS(teams::places, teams::averaged, 16)
INTEGRATE_IN_TEAMS(teams::hoppers, myriad::cash_karp, 4)
INTEGRATE_IN_TEAMS(teams::hoppers, myriad::cash_karp, 16)
INTEGRATE_IN_TEAMS(teams::hoppers, teams::sampled_8, 8)
INTEGRATE_IN_TEAMS(teams::drifters, myriad::dormand_prince_5, 8)
INTEGRATE_IN_TEAMS(teams::drifters, myriad::runge_kutta_4, 2)
INTEGRATE_IN_TEAMS(teams::watched_ring, myriad::cash_karp, 4)
INTEGRATE_IN_TEAMS(teams::watched_ring, myriad::dormand_prince_8, 8)
INTEGRATE_IN_TEAMS(teams::envious_ring, myriad::cash_karp, 8)
INTEGRATE_IN_TEAMS(teams::metered_line, myriad::runge_kutta_4, 8)
INTEGRATE_IN_TEAMS(teams::metered_line, teams::sampled, 16)
INTEGRATE_IN_TEAMS(teams::adapting_cells, myriad::cash_karp, 4)
INTEGRATE_IN_TEAMS(teams::adapting_cells, myriad::dormand_prince_5, 16)
INTEGRATE_IN_TEAMS(teams::noisy_places, myriad::milstein, 4)
INTEGRATE_IN_TEAMS(teams::noisy_places, teams::sriw1_by_halves, 8)
INTEGRATE_IN_TEAMS(teams::noisy_points, myriad::euler_maruyama, 4)
INTEGRATE_IN_TEAMS(teams::noisy_points, myriad::sra1, 16)
