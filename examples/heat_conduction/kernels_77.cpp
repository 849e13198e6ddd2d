// SPDX-License-Identifier: MIT
// Compiles the kernels of heat conduction at 77 points.
#include "heat_conduction.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(heat_77, myriad::tsitouras_5)
