// SPDX-License-Identifier: MIT
// Compiles the kernels of the pressure relief valve.
#include <myriad/instantiate.hpp>

#include "models.hpp"

MYRIAD_INSTANTIATE(gpu_ensembles::relief_valve, myriad::cash_karp)
