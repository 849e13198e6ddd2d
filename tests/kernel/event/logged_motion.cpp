// SPDX-License-Identifier: MIT
// Compiles, in packs, kernels of the models of logged_motion.hpp and of levels.hpp; time_models.cpp has the others.
#include "logged_motion.hpp"

#include <myriad/instantiate.hpp>

#include "levels.hpp"

MYRIAD_INSTANTIATE(logged_motion, myriad::runge_kutta_4, myriad::dormand_prince_8)
MYRIAD_INSTANTIATE(levels, myriad::cash_karp, myriad::runge_kutta_4)
