// SPDX-License-Identifier: MIT
// Compiles the kernels of heat conduction at 24 points.
#include "heat_conduction.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(heat_24, myriad::tsitouras_5)
