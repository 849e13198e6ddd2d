// SPDX-License-Identifier: MIT
// Compiles the kernels whose samples are compared.
#include <myriad/instantiate.hpp>

#include "tests/support/problems.hpp"

MYRIAD_INSTANTIATE(problems::van_der_pol, myriad::dense<myriad::runge_kutta_4>, myriad::dense<myriad::cash_karp>,
                   myriad::dense<myriad::tsitouras_5>)
MYRIAD_INSTANTIATE(problems::forced_duffing, myriad::dense<myriad::runge_kutta_4>, myriad::dense<myriad::cash_karp>,
                   myriad::dense<myriad::tsitouras_5>)
