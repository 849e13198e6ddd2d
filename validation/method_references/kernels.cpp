// SPDX-License-Identifier: MIT
// Compiles the kernels of the references.
#include <myriad/instantiate.hpp>

#include "benchmarks/methods/models.hpp"

MYRIAD_INSTANTIATE(methods::keller_miksis, myriad::dormand_prince_8)
MYRIAD_INSTANTIATE(methods::relief_valve, myriad::dormand_prince_8)
MYRIAD_INSTANTIATE(methods::robertson, myriad::rodas_5p)
