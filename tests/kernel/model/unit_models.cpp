// SPDX-License-Identifier: MIT
// The kernels of coupled units, and of the same systems written as a whole.
#include "tests/kernel/model/unit_models.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(units::ring_of_3, myriad::tsitouras_5, myriad::rodas_5p)
MYRIAD_INSTANTIATE(units::whole_ring_of_3, myriad::tsitouras_5, myriad::rodas_5p)
MYRIAD_INSTANTIATE(units::ring_of_20, myriad::cash_karp)
MYRIAD_INSTANTIATE(units::whole_ring_of_20, myriad::cash_karp)
