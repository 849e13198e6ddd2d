// SPDX-License-Identifier: MIT
// Compiles the kernels of the oscillator, in double and in single precision.
#include <myriad/instantiate.hpp>

#include "tests/support/problems.hpp"

#define ALL_METHODS myriad::runge_kutta_4, myriad::cash_karp, myriad::tsitouras_5

MYRIAD_INSTANTIATE(problems::oscillator, ALL_METHODS, myriad::dormand_prince_5, myriad::verner_7,
                   myriad::dormand_prince_8, myriad::verner_9)
MYRIAD_INSTANTIATE_FLOAT(problems::oscillator, ALL_METHODS)
