// SPDX-License-Identifier: MIT
// The kernels of the model with elementary functions.
#include "tests/properties/pack_sizes_body.hpp"

RUN_WITH_PACKS(properties::mixed, myriad::tsitouras_5, double)
#if defined(MYRIAD_NIGHTLY)
RUN_WITH_PACKS(properties::mixed, myriad::cash_karp, float)
#endif
