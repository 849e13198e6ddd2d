// SPDX-License-Identifier: MIT
// Compiles the kernel of the relief valve.
#include "relief_valve.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(relief_valve, myriad::cash_karp)
