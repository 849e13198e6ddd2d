// SPDX-License-Identifier: MIT
// Compiles the kernels of the Duffing oscillator for methods of orders seven and eight.
#include <myriad/instantiate.hpp>

#include "model.hpp"

using dormand_prince_8_pi = myriad::controlled<myriad::dormand_prince_8, myriad::pi_control>;
MYRIAD_INSTANTIATE(cpu_peers::duffing_model, myriad::verner_7, dormand_prince_8_pi)
