// SPDX-License-Identifier: MIT
// Compiles the kernel of the epidemic.
#include "epidemic.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(epidemic, myriad::tsitouras_5)
