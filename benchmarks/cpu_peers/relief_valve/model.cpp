// SPDX-License-Identifier: MIT
// Compiles the kernel of the pressure relief valve.
#include "model.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(cpu_peers::relief_valve_model, myriad::cash_karp)
