// SPDX-License-Identifier: MIT
// Compiles the kernels of the seven stars.
#include <myriad/instantiate.hpp>

#include "pleiades.hpp"

MYRIAD_INSTANTIATE(gpu_ensembles::pleiades, myriad::tsitouras_5, myriad::dormand_prince_8)
MYRIAD_INSTANTIATE(gpu_ensembles::pleiades_units, myriad::tsitouras_5, myriad::dormand_prince_8)
