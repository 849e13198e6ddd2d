// SPDX-License-Identifier: MIT
// Compiles the kernels of the neutral equations.
#include "neutral_models.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(neutral::fading, myriad::dormand_prince_5, myriad::runge_kutta_4, myriad::verner_7)
MYRIAD_INSTANTIATE(neutral::sawtooth, myriad::dormand_prince_5, myriad::cash_karp)
MYRIAD_INSTANTIATE(neutral::logarithm, myriad::dormand_prince_5)
