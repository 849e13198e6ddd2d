// SPDX-License-Identifier: MIT
// Compiles, in packs, kernels of the models that the tests of events watch and of levels; time_models.cpp has the
// others.
#include "watch.hpp"

#include <myriad/instantiate.hpp>

#include "levels.hpp"

MYRIAD_INSTANTIATE(watch, myriad::runge_kutta_4, myriad::dormand_prince_8)
MYRIAD_INSTANTIATE(levels, myriad::cash_karp, myriad::runge_kutta_4)
