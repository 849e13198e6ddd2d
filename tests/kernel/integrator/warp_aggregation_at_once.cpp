// SPDX-License-Identifier: MIT
// Compiles the kernels whose threads go on at once.
#include <myriad/instantiate.hpp>

#include "tests/kernel/integrator/warp_aggregation.hpp"

MYRIAD_INSTANTIATE(warp_aggregation::at_once, myriad::cash_karp, myriad::runge_kutta_4)
