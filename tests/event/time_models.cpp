// SPDX-License-Identifier: MIT
// Compiles the kernels of the models of time_models.hpp.
#include "time_models.hpp"

#include <myriad/instantiate.hpp>

#include "methods.hpp"

MYRIAD_INSTANTIATE(wave, ALL_METHODS)
MYRIAD_INSTANTIATE(gate, ALL_METHODS)
MYRIAD_INSTANTIATE(pendulum, ALL_METHODS)
MYRIAD_INSTANTIATE(walled, ALL_METHODS)
