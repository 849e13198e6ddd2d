// SPDX-License-Identifier: MIT
// Compiles the kernels of the models of time_models.hpp.
#include "time_models.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(wave, myriad::cash_karp, myriad::tsitouras_5, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(gate, myriad::cash_karp, myriad::tsitouras_5, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(pendulum, myriad::cash_karp, myriad::tsitouras_5, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(walled, myriad::cash_karp, myriad::tsitouras_5, myriad::runge_kutta_4)
