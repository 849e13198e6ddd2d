// SPDX-License-Identifier: MIT
// Compiles the kernels of the forced Duffing oscillator with both of its tangents.
#include "lyapunov_map_spectrum.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(duffing_spectrum, myriad::tsitouras_5)
