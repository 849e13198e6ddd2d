// SPDX-License-Identifier: MIT
// Compiles the kernels of the models for phases that events do not end.
#include <myriad/instantiate.hpp>

#include "tests/support/hooked.hpp"

// cash_karp.cpp has those of cash_karp.
#define MOST_METHODS myriad::runge_kutta_4, myriad::tsitouras_5

MYRIAD_INSTANTIATE(hooked::phased, MOST_METHODS)
MYRIAD_INSTANTIATE_FLOAT(hooked::phased, MOST_METHODS)
MYRIAD_INSTANTIATE(hooked::stopper, MOST_METHODS)
MYRIAD_INSTANTIATE(hooked::ramp, MOST_METHODS)
MYRIAD_INSTANTIATE(hooked::renormalised, MOST_METHODS)
