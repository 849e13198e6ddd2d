// SPDX-License-Identifier: MIT
// Compiles the kernels of the test problems with exact solutions.
#include "tests/support/problems.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(problems::log_circle, myriad::runge_kutta_4, myriad::cash_karp, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(problems::timed_circle, myriad::runge_kutta_4, myriad::cash_karp, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(problems::two_speeds, myriad::cash_karp)
