// SPDX-License-Identifier: MIT
// Compiles the kernels of the Duffing oscillator.
#include "duffing.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(duffing, myriad::cash_karp)
