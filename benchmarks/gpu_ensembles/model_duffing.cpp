// SPDX-License-Identifier: MIT
// Compiles the kernels of the Duffing oscillator of the examples.
#include <myriad/instantiate.hpp>

#include "examples/duffing/duffing.hpp"

MYRIAD_INSTANTIATE(duffing, myriad::cash_karp)
