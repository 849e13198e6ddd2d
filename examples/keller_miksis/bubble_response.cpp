// SPDX-License-Identifier: MIT
// Compiles the kernels of the Keller-Miksis bubble that the program `bubble_response` integrates.
#include <myriad/instantiate.hpp>

#include "keller_miksis.hpp"

MYRIAD_INSTANTIATE(bubble_response, myriad::cash_karp)
