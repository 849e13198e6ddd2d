// SPDX-License-Identifier: MIT
// Compiles the kernels whose threads wait three turns before each event, as a GPU's threads do for each other.
#include <myriad/instantiate.hpp>

#include "tests/kernel/integrator/warp_aggregation.hpp"

MYRIAD_INSTANTIATE(warp_aggregation::waiting, myriad::cash_karp, myriad::runge_kutta_4)
