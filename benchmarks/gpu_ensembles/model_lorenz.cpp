// SPDX-License-Identifier: MIT
// Compiles the kernels of Lorenz' equations.
#include <myriad/instantiate.hpp>

#include "models.hpp"

MYRIAD_INSTANTIATE(gpu_ensembles::lorenz, myriad::runge_kutta_4, myriad::tsitouras_5, myriad::verner_7,
                   myriad::dormand_prince_8)
MYRIAD_INSTANTIATE(gpu_ensembles::tutorial_lorenz, myriad::runge_kutta_4)
