// SPDX-License-Identifier: MIT
// Compiles the kernels of the models with events, and of one that looks early.
#include <myriad/instantiate.hpp>

#include "tests/support/hooked.hpp"

#define ALL_METHODS myriad::runge_kutta_4, myriad::cash_karp, myriad::tsitouras_5

MYRIAD_INSTANTIATE(hooked::phased_by_events, ALL_METHODS)
MYRIAD_INSTANTIATE(hooked::watched, ALL_METHODS)
MYRIAD_INSTANTIATE(hooked::early_reader, ALL_METHODS)
