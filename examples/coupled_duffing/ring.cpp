// SPDX-License-Identifier: MIT
// Compiles the kernels of the ring.
#include "ring.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(ring, myriad::cash_karp)
