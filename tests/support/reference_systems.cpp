// SPDX-License-Identifier: MIT
// Compiles the kernels of the systems with reference values.
#include <myriad/instantiate.hpp>

#include "tests/support/problems.hpp"

#define ALL_METHODS myriad::runge_kutta_4, myriad::cash_karp, myriad::tsitouras_5

MYRIAD_INSTANTIATE(problems::lorenz, ALL_METHODS)
MYRIAD_INSTANTIATE(problems::forced_duffing, ALL_METHODS)
MYRIAD_INSTANTIATE(problems::van_der_pol, ALL_METHODS)
MYRIAD_INSTANTIATE(problems::pendulum, ALL_METHODS)
