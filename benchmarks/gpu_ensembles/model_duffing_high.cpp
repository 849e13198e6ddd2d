// SPDX-License-Identifier: MIT
// Compiles the Duffing oscillator's kernels by a method of high order, only for GPUs.
#include <myriad/instantiate.hpp>

#include "examples/duffing/duffing.hpp"

#if defined(__CUDACC__)
MYRIAD_INSTANTIATE(duffing, myriad::verner_7)
#endif
