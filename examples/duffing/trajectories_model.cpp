// SPDX-License-Identifier: MIT
// Compiles the kernels of the Duffing oscillator with dense output.
#include <myriad/instantiate.hpp>

#include "duffing.hpp"

MYRIAD_INSTANTIATE(duffing, myriad::dense<myriad::tsitouras_5>)
