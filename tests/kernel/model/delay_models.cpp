// SPDX-License-Identifier: MIT
// Compiles the kernels of the models with delays.
#include "delay_models.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(delays::decay, myriad::dormand_prince_5, myriad::runge_kutta_4, myriad::dense<myriad::tsitouras_5>)
MYRIAD_INSTANTIATE_FLOAT(delays::decay, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(delays::chain, myriad::dormand_prince_5, myriad::verner_7)
MYRIAD_INSTANTIATE(delays::logarithm, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(delays::pantograph, myriad::verner_7, myriad::cash_karp)
MYRIAD_INSTANTIATE(delays::watched_pantograph, myriad::verner_7)
MYRIAD_INSTANTIATE(delays::exponential, myriad::dormand_prince_5, myriad::rodas_5p)
MYRIAD_INSTANTIATE(delays::echo, myriad::dormand_prince_5, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(delays::recurrent, myriad::dormand_prince_5, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(delays::rare, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(delays::frozen, myriad::dormand_prince_5)
