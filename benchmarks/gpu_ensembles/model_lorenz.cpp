// SPDX-License-Identifier: MIT
// Compiles the kernels of Lorenz' equations.
#include <myriad/instantiate.hpp>

#include "models.hpp"

MYRIAD_INSTANTIATE(gpu_ensembles::lorenz, myriad::runge_kutta_4, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(gpu_ensembles::tutorial_lorenz, myriad::runge_kutta_4)
