// SPDX-License-Identifier: MIT
// Compiles the kernels of the model that the tests of events watch.
#include "watch.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(watch, myriad::cash_karp, myriad::tsitouras_5, myriad::runge_kutta_4, myriad::dormand_prince_8)
MYRIAD_INSTANTIATE_FLOAT(watch, myriad::cash_karp)
