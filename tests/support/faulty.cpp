// SPDX-License-Identifier: MIT
// Compiles the kernels of the models that go wrong.
#include "tests/support/faulty.hpp"

#include <myriad/instantiate.hpp>

// cash_karp.cpp has those of cash_karp.
#define MOST_METHODS myriad::runge_kutta_4, myriad::tsitouras_5

MYRIAD_INSTANTIATE(faulty::clock_fault, MOST_METHODS)
MYRIAD_INSTANTIATE_FLOAT(faulty::clock_fault, MOST_METHODS)
MYRIAD_INSTANTIATE(faulty::domain_fault, MOST_METHODS)
MYRIAD_INSTANTIATE(faulty::cliff, MOST_METHODS)
MYRIAD_INSTANTIATE(faulty::blow_up, MOST_METHODS)
MYRIAD_INSTANTIATE_FLOAT(faulty::blow_up, MOST_METHODS)
MYRIAD_INSTANTIATE(faulty::slope_jump, MOST_METHODS)
MYRIAD_INSTANTIATE(faulty::hook_fault, MOST_METHODS)
