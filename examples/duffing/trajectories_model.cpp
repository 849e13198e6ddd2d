// SPDX-License-Identifier: MIT
// Compiles the kernels of the Duffing oscillator with dense output.
#include "duffing.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(duffing, myriad::dense<myriad::tsitouras_5>)
