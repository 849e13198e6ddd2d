// SPDX-License-Identifier: MIT
// Compiles the kernels of the pressure relief valve for methods of order five.
#include <myriad/instantiate.hpp>

#include "models.hpp"

MYRIAD_INSTANTIATE(methods::relief_valve, myriad::cash_karp, myriad::dormand_prince_5, myriad::tsitouras_5,
                   methods::tsitouras_5_pi)
