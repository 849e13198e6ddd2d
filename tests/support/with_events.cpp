// SPDX-License-Identifier: MIT
// Compiles the kernels of the models with events, and of one that looks early.
#include <myriad/instantiate.hpp>

#include "tests/support/hooked.hpp"

// cash_karp.cpp has those of cash_karp.
#define MOST_METHODS myriad::runge_kutta_4, myriad::tsitouras_5

MYRIAD_INSTANTIATE(hooked::phased_by_events, MOST_METHODS)
MYRIAD_INSTANTIATE(hooked::hooks_logged, MOST_METHODS)
MYRIAD_INSTANTIATE(hooked::early_reader, MOST_METHODS)
