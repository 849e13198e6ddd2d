// SPDX-License-Identifier: MIT
// Compiles the bubble's kernels of high order, only for GPUs.
#include <myriad/instantiate.hpp>

#include "models.hpp"

#if defined(__CUDACC__)
MYRIAD_INSTANTIATE(gpu_ensembles::keller_miksis, myriad::verner_7, myriad::dormand_prince_8,
                   gpu_ensembles::dormand_prince_8_pi)
#endif
