// SPDX-License-Identifier: MIT
// Compiles the kernels whose threads wait three turns before each event, as a GPU's threads do for company.
#include <myriad/instantiate.hpp>

#include "tests/kernel/integrator/company.hpp"

MYRIAD_INSTANTIATE(company::waiting, myriad::cash_karp, myriad::runge_kutta_4)
