// SPDX-License-Identifier: MIT
// Compiles the kernels of heat conduction at 77 points.
#include <myriad/instantiate.hpp>

#include "heat_conduction.hpp"

MYRIAD_INSTANTIATE(heat_77, myriad::tsitouras_5)
