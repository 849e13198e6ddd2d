// SPDX-License-Identifier: MIT
// Compiles the kernels with dense output of the models that jump and turn.
#include <myriad/instantiate.hpp>

#include "tests/kernel/output/models.hpp"

MYRIAD_INSTANTIATE(output::bouncing, myriad::dense<myriad::runge_kutta_4>, myriad::dense<myriad::cash_karp>,
                   myriad::dense<myriad::tsitouras_5>)
MYRIAD_INSTANTIATE(output::retargeted, myriad::dense<myriad::runge_kutta_4>, myriad::dense<myriad::cash_karp>)
