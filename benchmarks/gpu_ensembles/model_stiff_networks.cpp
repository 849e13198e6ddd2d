// SPDX-License-Identifier: MIT
// Compiles the kernels of stiff networks in double precision.
#include <myriad/instantiate.hpp>

#include "stiff_networks.hpp"

MYRIAD_INSTANTIATE(problems::pollution, myriad::rodas_5p, myriad::rosenbrock_23)
MYRIAD_INSTANTIATE(problems::van_der_pol_ring<8>, myriad::rodas_5p)
MYRIAD_INSTANTIATE(problems::van_der_pol_ring<32>, myriad::rodas_5p)
MYRIAD_INSTANTIATE(problems::van_der_pol_ring<64>, myriad::rodas_5p)
MYRIAD_INSTANTIATE(gpu_ensembles::robertson, myriad::rodas_5p)
