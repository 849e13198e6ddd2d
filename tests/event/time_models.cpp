// SPDX-License-Identifier: MIT
// Compiles the kernels of the models of time_models.hpp.
#include "time_models.hpp"

#include <myriad/instantiate.hpp>

#define ALL_METHODS myriad::cash_karp, myriad::tsitouras_5, myriad::runge_kutta_4, myriad::dormand_prince_8

MYRIAD_INSTANTIATE(wave, ALL_METHODS)
MYRIAD_INSTANTIATE(gate, ALL_METHODS)
MYRIAD_INSTANTIATE(pendulum, ALL_METHODS)
MYRIAD_INSTANTIATE(walled, ALL_METHODS)
