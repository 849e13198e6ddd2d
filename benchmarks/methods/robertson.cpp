// SPDX-License-Identifier: MIT
// Compiles the kernels of Robertson's reaction.
#include <myriad/instantiate.hpp>

#include "models.hpp"

MYRIAD_INSTANTIATE(methods::robertson, myriad::rosenbrock_23, myriad::rodas_5p, methods::rodas_5p_pi)
