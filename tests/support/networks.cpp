// SPDX-License-Identifier: MIT
// Compiles the kernels of stiff networks.
#include <myriad/instantiate.hpp>

#include "problems/hires.hpp"
#include "problems/pollution.hpp"
#include "problems/van_der_pol_ring.hpp"

MYRIAD_INSTANTIATE(problems::hires, myriad::rodas_5p)
MYRIAD_INSTANTIATE(problems::pollution, myriad::rodas_5p)
MYRIAD_INSTANTIATE(problems::van_der_pol_ring<48>, myriad::rodas_5p, myriad::dormand_prince_8)
