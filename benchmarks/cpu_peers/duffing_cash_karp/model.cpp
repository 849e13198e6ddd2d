// SPDX-License-Identifier: MIT
// Compiles the kernel of the Duffing oscillator.
#include "model.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(cpu_peers::duffing_model, myriad::cash_karp)
