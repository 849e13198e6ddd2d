// SPDX-License-Identifier: MIT
// Compiles the kernels of the models with hooks that write states and accessories.
#include <myriad/instantiate.hpp>

#include "tests/support/hooked.hpp"

// cash_karp.cpp has those of cash_karp.
#define MOST_METHODS myriad::runge_kutta_4, myriad::tsitouras_5

MYRIAD_INSTANTIATE(hooked::kicked_scalar, MOST_METHODS)
MYRIAD_INSTANTIATE(hooked::kicked_generic, MOST_METHODS)
MYRIAD_INSTANTIATE(hooked::kicked_scalar, myriad::dense<myriad::runge_kutta_4>, myriad::dense<myriad::tsitouras_5>)
MYRIAD_INSTANTIATE(hooked::bookkeeper, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(hooked::declared_bookkeeper, myriad::tsitouras_5)
