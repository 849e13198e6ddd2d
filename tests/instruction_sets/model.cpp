// SPDX-License-Identifier: MIT
// Compiles the kernels, once for each instruction set.
#include "model.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(bouncing_pendulum, myriad::cash_karp)
