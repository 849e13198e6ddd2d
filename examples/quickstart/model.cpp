// SPDX-License-Identifier: MIT
// Compiles the model of the README for the CPU's SIMD lanes.
// snippet: instantiation
#include "model.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(duffing, myriad::cash_karp)
// end of snippet
