// SPDX-License-Identifier: MIT
// Compiles the kernels of the pressure relief valve for methods of orders seven and eight.
#include <myriad/instantiate.hpp>

#include "models.hpp"

MYRIAD_INSTANTIATE(methods::relief_valve, myriad::verner_7, myriad::dormand_prince_8, methods::dormand_prince_8_pi,
                   methods::dormand_prince_8_rms)
