// SPDX-License-Identifier: MIT
// Compiles, in packs, kernels of the model that the tests of events watch; time_models.cpp has the others.
#include "watch.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(watch, myriad::runge_kutta_4, myriad::dormand_prince_8)
