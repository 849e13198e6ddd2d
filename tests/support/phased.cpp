// SPDX-License-Identifier: MIT
// Compiles the kernels of the models for phases that events do not end.
#include <myriad/instantiate.hpp>

#include "tests/support/hooked.hpp"

#define ALL_METHODS myriad::runge_kutta_4, myriad::cash_karp, myriad::tsitouras_5

MYRIAD_INSTANTIATE(hooked::phased, ALL_METHODS)
MYRIAD_INSTANTIATE_FLOAT(hooked::phased, ALL_METHODS)
MYRIAD_INSTANTIATE(hooked::stopper, ALL_METHODS)
MYRIAD_INSTANTIATE(hooked::ramp, ALL_METHODS)
MYRIAD_INSTANTIATE(hooked::renormalised, ALL_METHODS)
