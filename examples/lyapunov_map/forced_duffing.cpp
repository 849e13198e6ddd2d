// SPDX-License-Identifier: MIT
// Compiles the kernels of the forced Duffing oscillator with both kinds of tangents.
#include "forced_duffing.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(hand_tangent, myriad::dormand_prince_8)
MYRIAD_INSTANTIATE(library_tangent, myriad::dormand_prince_8)
