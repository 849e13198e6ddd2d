// SPDX-License-Identifier: MIT
// The kernels of the models that studies are tested with.
#include "tests/study/models.hpp"

#include <myriad/instantiate.hpp>

#include "tests/kernel/model/delay_models.hpp"

MYRIAD_INSTANTIATE(studied::duffing, myriad::dense<myriad::tsitouras_5>)
MYRIAD_INSTANTIATE_FLOAT(studied::lorenz, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(studied::wave, myriad::cash_karp)
MYRIAD_INSTANTIATE(delays::echo, myriad::cash_karp)
