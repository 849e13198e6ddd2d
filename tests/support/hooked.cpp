// SPDX-License-Identifier: MIT
// Compiles the kernels of the models with hooks that read, or write parameters and times.
#include "tests/support/hooked.hpp"

#include <myriad/instantiate.hpp>

// cash_karp.cpp has those of cash_karp.
#define MOST_METHODS myriad::runge_kutta_4, myriad::tsitouras_5

MYRIAD_INSTANTIATE(hooked::running_scalar, MOST_METHODS)
MYRIAD_INSTANTIATE(hooked::running_generic, MOST_METHODS)
MYRIAD_INSTANTIATE(hooked::parameter_writer, MOST_METHODS)
MYRIAD_INSTANTIATE(hooked::domain_writer, MOST_METHODS)
MYRIAD_INSTANTIATE(hooked::reader, MOST_METHODS)
MYRIAD_INSTANTIATE_FLOAT(hooked::reader, MOST_METHODS)
