// SPDX-License-Identifier: MIT
// Compiles the kernels of the Keller-Miksis bubble.
#include <myriad/instantiate.hpp>

#include "models.hpp"

MYRIAD_INSTANTIATE(gpu_ensembles::keller_miksis, myriad::cash_karp)
