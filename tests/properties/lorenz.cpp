// SPDX-License-Identifier: MIT
// The kernels of Lorenz' equations.
#include "tests/properties/pack_sizes_body.hpp"

RUN_WITH_PACKS(properties::lorenz, myriad::runge_kutta_4, double)
RUN_WITH_PACKS(properties::lorenz, myriad::cash_karp, float)
