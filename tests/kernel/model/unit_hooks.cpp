// SPDX-License-Identifier: MIT
// The kernels of coupled units with couplings, hooks and tangents.
#include <myriad/instantiate.hpp>

#include "tests/kernel/model/unit_models.hpp"

MYRIAD_INSTANTIATE(units::phases_of_19, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(units::balls_of_2, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(units::balls_of_9, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(units::ring_of_3_with_tangents, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(units::whole_ring_of_3_with_tangents, myriad::tsitouras_5)
