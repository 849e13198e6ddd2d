// SPDX-License-Identifier: MIT
// Compiles the kernels of the models whose results must depend only on the instance.
#include "tests/properties/models.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(properties::lorenz, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE_FLOAT(properties::lorenz, myriad::cash_karp)
MYRIAD_INSTANTIATE(properties::mixed, myriad::tsitouras_5, myriad::cash_karp)
MYRIAD_INSTANTIATE(properties::bouncer, myriad::cash_karp)
#if defined(MYRIAD_NIGHTLY)
MYRIAD_INSTANTIATE_FLOAT(properties::mixed, myriad::cash_karp)
MYRIAD_INSTANTIATE(properties::bouncer, myriad::runge_kutta_4)
#endif
