// SPDX-License-Identifier: MIT
// Compiles the kernels: with hooks, and with dense output instead.
#include "oscillator.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(response, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(oscillator, myriad::dense<myriad::tsitouras_5>)
