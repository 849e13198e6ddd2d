// SPDX-License-Identifier: MIT
// Compiles the kernel of Roessler's equations.
#include "roessler.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(roessler, myriad::tsitouras_5)
