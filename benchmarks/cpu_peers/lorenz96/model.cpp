// SPDX-License-Identifier: MIT
// Compiles the kernels of Lorenz 96.
#include <myriad/instantiate.hpp>

#include "benchmarks/gpu_ensembles/lorenz96.hpp"

MYRIAD_INSTANTIATE(gpu_ensembles::lorenz96<32>, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(gpu_ensembles::lorenz96<128>, myriad::dormand_prince_5)
