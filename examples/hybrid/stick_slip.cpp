// SPDX-License-Identifier: MIT
// Compiles the kernels of the block on a belt.
#include "stick_slip.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(stick_slip, myriad::tsitouras_5)
