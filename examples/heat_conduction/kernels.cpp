// SPDX-License-Identifier: MIT
// Compiles the kernels of heat conduction at 24 points.
#include <myriad/instantiate.hpp>

#include "heat_conduction.hpp"

MYRIAD_INSTANTIATE(heat_24, myriad::tsitouras_5, myriad::rodas_5p)
