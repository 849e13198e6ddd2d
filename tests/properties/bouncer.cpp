// SPDX-License-Identifier: MIT
// The kernels of the impact model.
#include "tests/properties/pack_sizes_body.hpp"

RUN_WITH_PACKS(properties::bouncer, myriad::cash_karp, double)
#if defined(MYRIAD_NIGHTLY)
RUN_WITH_PACKS(properties::bouncer, myriad::runge_kutta_4, double)
#endif
