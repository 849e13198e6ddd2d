// SPDX-License-Identifier: MIT
// Compiles the kernels of Lorenz' equations with their tangents.
#include "lorenz.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(lorenz_spectrum, myriad::tsitouras_5)
