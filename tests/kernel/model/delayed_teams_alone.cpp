// SPDX-License-Identifier: MIT
// Compiles the kernels of one thread per instance.
#include <myriad/instantiate.hpp>

#include "tests/kernel/model/delayed_teams.hpp"

namespace delayed_teams {
using phases_alone = phases<1>;
using cells_alone = cells<1>;
using pairs_alone = pairs<1>;
using echoes_alone = echoes<1>;
}  // namespace delayed_teams

MYRIAD_INSTANTIATE(delayed_teams::phases_alone, myriad::tsitouras_5, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(delayed_teams::pairs_alone, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(delayed_teams::cells_alone, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(delayed_teams::echoes_alone, myriad::cash_karp, myriad::runge_kutta_4)
