// SPDX-License-Identifier: MIT
// Compiles the kernels of the test problems with exact solutions.
#include "tests/support/problems.hpp"

#include <myriad/instantiate.hpp>

#define ALL_METHODS                                                                                            \
    myriad::runge_kutta_4, myriad::cash_karp, myriad::tsitouras_5, myriad::dormand_prince_5, myriad::verner_7, \
        myriad::dormand_prince_8, myriad::verner_9

MYRIAD_INSTANTIATE(problems::log_circle, ALL_METHODS)
MYRIAD_INSTANTIATE(problems::timed_circle, ALL_METHODS)
MYRIAD_INSTANTIATE(problems::two_speeds, myriad::cash_karp)
