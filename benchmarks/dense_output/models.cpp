// SPDX-License-Identifier: MIT
// Compiles the kernels with and without dense output.
#include "models.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(forced_oscillator, myriad::runge_kutta_4, myriad::cash_karp, myriad::tsitouras_5,
                   myriad::dense<myriad::runge_kutta_4>, myriad::dense<myriad::cash_karp>,
                   myriad::dense<myriad::tsitouras_5>)
