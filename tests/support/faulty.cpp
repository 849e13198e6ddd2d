// SPDX-License-Identifier: MIT
// Compiles the kernels of the models that go wrong.
#include "tests/support/faulty.hpp"

#include <myriad/instantiate.hpp>

#define ALL_METHODS myriad::runge_kutta_4, myriad::cash_karp, myriad::tsitouras_5

MYRIAD_INSTANTIATE(faulty::clock_fault, ALL_METHODS)
MYRIAD_INSTANTIATE_FLOAT(faulty::clock_fault, ALL_METHODS)
MYRIAD_INSTANTIATE(faulty::domain_fault, ALL_METHODS)
MYRIAD_INSTANTIATE(faulty::blow_up, ALL_METHODS)
MYRIAD_INSTANTIATE_FLOAT(faulty::blow_up, ALL_METHODS)
MYRIAD_INSTANTIATE(faulty::slope_jump, ALL_METHODS)
MYRIAD_INSTANTIATE(faulty::hook_fault, ALL_METHODS)
