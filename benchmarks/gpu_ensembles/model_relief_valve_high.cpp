// SPDX-License-Identifier: MIT
// Compiles the valve's kernels of high order, only for GPUs.
#include <myriad/instantiate.hpp>

#include "models.hpp"

#if defined(__CUDACC__)
MYRIAD_INSTANTIATE(gpu_ensembles::relief_valve, myriad::verner_7, myriad::dormand_prince_8)
#endif
