// SPDX-License-Identifier: MIT
// Compiles the kernels of stiff networks in single precision.
#include <myriad/instantiate.hpp>

#include "stiff_networks.hpp"

MYRIAD_INSTANTIATE_FLOAT(problems::pollution, myriad::rodas_5p)
MYRIAD_INSTANTIATE_FLOAT(problems::van_der_pol_ring<8>, myriad::rodas_5p)
MYRIAD_INSTANTIATE_FLOAT(problems::van_der_pol_ring<32>, myriad::rodas_5p)
