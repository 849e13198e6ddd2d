// SPDX-License-Identifier: MIT
// Compiles the kernels of the DETEST problems.
#include <myriad/instantiate.hpp>

#include "tests/support/problems.hpp"

#define ALL_METHODS myriad::runge_kutta_4, myriad::cash_karp, myriad::tsitouras_5

MYRIAD_INSTANTIATE(problems::decay, ALL_METHODS)
MYRIAD_INSTANTIATE(problems::power_decay, ALL_METHODS)
MYRIAD_INSTANTIATE(problems::modulated_growth, ALL_METHODS)
MYRIAD_INSTANTIATE(problems::logistic, ALL_METHODS)
