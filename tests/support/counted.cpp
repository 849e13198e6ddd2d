// SPDX-License-Identifier: MIT
// Compiles the kernels of the models that count their evaluations.
#include "tests/support/counted.hpp"

#include <myriad/instantiate.hpp>

#define ALL_METHODS myriad::runge_kutta_4, myriad::cash_karp, myriad::tsitouras_5

MYRIAD_INSTANTIATE(counted::oscillator, ALL_METHODS)
MYRIAD_INSTANTIATE(counted::with_events, ALL_METHODS)
MYRIAD_INSTANTIATE(counted::bouncing, ALL_METHODS)
MYRIAD_INSTANTIATE(counted::idle_hook, ALL_METHODS)
MYRIAD_INSTANTIATE(counted::busy_hook, ALL_METHODS)
