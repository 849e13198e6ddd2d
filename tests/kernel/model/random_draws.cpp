// SPDX-License-Identifier: MIT
// Compiles the kernels that record random numbers.
#include "tests/kernel/model/random_draws.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(random_draws::draws, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE_FLOAT(random_draws::draws, myriad::runge_kutta_4)
