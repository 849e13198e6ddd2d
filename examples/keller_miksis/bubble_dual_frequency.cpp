// SPDX-License-Identifier: MIT
// Compiles the kernels of the Keller-Miksis bubble that the program `bubble_dual_frequency` integrates.
#include <myriad/instantiate.hpp>

#include "keller_miksis.hpp"

MYRIAD_INSTANTIATE(bubble_dual_frequency, myriad::cash_karp)
