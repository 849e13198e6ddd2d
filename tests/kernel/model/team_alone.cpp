// SPDX-License-Identifier: MIT
// Compiles the kernels of one thread per instance.
#include <myriad/instantiate.hpp>

#include "tests/kernel/model/teams.hpp"

namespace teams {
using places_alone = places<1>;
using phases_alone = phases<1>;
using ring_alone = ring<1>;
using hoppers_alone = hoppers<1>;
using drifters_alone = drifters<1>;
using watched_alone = watched_ring<1>;
using envious_alone = envious_ring<1>;
using metered_alone = metered_line<1>;
using adapting_alone = adapting_cells<1>;
using noisy_alone = noisy_places<1>;
using points_alone = noisy_points<1>;
}  // namespace teams

MYRIAD_INSTANTIATE(teams::places_alone, teams::with_memory, myriad::dormand_prince_8, myriad::runge_kutta_4,
                   teams::sampled, teams::averaged)
MYRIAD_INSTANTIATE(teams::phases_alone, myriad::cash_karp)
MYRIAD_INSTANTIATE(teams::hoppers_alone, myriad::cash_karp, teams::sampled_8)
MYRIAD_INSTANTIATE(teams::drifters_alone, myriad::dormand_prince_5, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(teams::ring_alone, teams::careful_start)
MYRIAD_INSTANTIATE(teams::watched_alone, myriad::cash_karp, myriad::dormand_prince_8)
MYRIAD_INSTANTIATE(teams::envious_alone, myriad::cash_karp)
MYRIAD_INSTANTIATE(teams::metered_alone, myriad::runge_kutta_4, teams::sampled)
MYRIAD_INSTANTIATE(teams::adapting_alone, myriad::cash_karp, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(teams::noisy_alone, myriad::milstein, teams::sriw1_by_halves)
MYRIAD_INSTANTIATE(teams::points_alone, myriad::euler_maruyama, myriad::sra1)
MYRIAD_INSTANTIATE(teams::whole_of_points, myriad::euler_maruyama, myriad::sra1)
