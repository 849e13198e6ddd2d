// SPDX-License-Identifier: MIT
// The kernels of coupled units by one thread and by teams.
#include <myriad/instantiate.hpp>

#include "tests/kernel/model/teams.hpp"

namespace teams {
using places_of_1 = places<1>;
using places_of_8 = places<8>;
using places_of_32 = places<32>;
using places_of_64 = places<64>;
using phases_of_16 = phases<16>;
using hoppers_of_8 = hoppers<8>;
using hoppers_of_128 = hoppers<128>;
}  // namespace teams

MYRIAD_INSTANTIATE(teams::places_of_1, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(teams::places_of_8, myriad::tsitouras_5, teams::averaged)
MYRIAD_INSTANTIATE(teams::places_of_32, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(teams::places_of_64, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(teams::phases_of_16, myriad::cash_karp)
MYRIAD_INSTANTIATE(teams::hoppers_of_8, teams::sampled)
MYRIAD_INSTANTIATE(teams::hoppers_of_128, teams::sampled)
