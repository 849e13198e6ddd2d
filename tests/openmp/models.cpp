// SPDX-License-Identifier: MIT
// Compiles the kernels of the models for the tests of teams of threads, for the CPU alone.
#include "models.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(teams::ring, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(teams::thrower, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(teams::root, myriad::cash_karp)
