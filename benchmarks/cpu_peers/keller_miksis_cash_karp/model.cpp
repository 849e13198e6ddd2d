// SPDX-License-Identifier: MIT
// Compiles the kernel of the Keller-Miksis bubble.
#include "model.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(cpu_peers::keller_miksis_model, myriad::cash_karp)
