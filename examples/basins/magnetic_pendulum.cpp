// SPDX-License-Identifier: MIT
// Compiles the kernels of the magnetic pendulum.
#include "magnetic_pendulum.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(magnetic_pendulum, myriad::dormand_prince_8)
