// SPDX-License-Identifier: MIT
// Compiles the particle's kernel.
#include <myriad/instantiate.hpp>

#include "bistable.hpp"

// snippet: instantiate
MYRIAD_INSTANTIATE(bistable, myriad::euler_maruyama)
// end of snippet
