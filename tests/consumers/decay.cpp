// SPDX-License-Identifier: MIT
// Compiles the model for the CPU's SIMD lanes.
#include "decay.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(decay, myriad::cash_karp)
