// SPDX-License-Identifier: MIT
// Compiles the kernels of coupled units with delays.
#include <myriad/instantiate.hpp>
#include <myriad/methods.hpp>

#include "benchmarks/gpu_ensembles/delayed_kuramoto.hpp"

namespace gpu_ensembles {
using alone_64 = delayed_phases<64, 1>;
using together_64 = delayed_phases<64, 0>;
using half_warp_64 = delayed_phases<64, 16>;
using alone_100 = delayed_phases<100, 1>;
using together_100 = delayed_phases<100, 0>;
}  // namespace gpu_ensembles

MYRIAD_INSTANTIATE(gpu_ensembles::alone_64, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(gpu_ensembles::together_64, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(gpu_ensembles::half_warp_64, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(gpu_ensembles::alone_100, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(gpu_ensembles::together_100, myriad::dormand_prince_5)
