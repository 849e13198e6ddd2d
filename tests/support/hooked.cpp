// SPDX-License-Identifier: MIT
// Compiles the kernels of the models with hooks.
#include "tests/support/hooked.hpp"

#include <myriad/instantiate.hpp>

#define ALL_METHODS myriad::runge_kutta_4, myriad::cash_karp, myriad::tsitouras_5

MYRIAD_INSTANTIATE(hooked::running_scalar, ALL_METHODS)
MYRIAD_INSTANTIATE(hooked::running_generic, ALL_METHODS)
MYRIAD_INSTANTIATE(hooked::parameter_writer, ALL_METHODS)
MYRIAD_INSTANTIATE(hooked::domain_writer, ALL_METHODS)
MYRIAD_INSTANTIATE(hooked::reader, ALL_METHODS)
MYRIAD_INSTANTIATE_FLOAT(hooked::reader, ALL_METHODS)
MYRIAD_INSTANTIATE(hooked::kicked_scalar, ALL_METHODS)
MYRIAD_INSTANTIATE(hooked::kicked_generic, ALL_METHODS)
MYRIAD_INSTANTIATE(hooked::kicked_scalar, myriad::dense<myriad::runge_kutta_4>, myriad::dense<myriad::cash_karp>,
                   myriad::dense<myriad::tsitouras_5>)
MYRIAD_INSTANTIATE(hooked::bookkeeper, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(hooked::declared_bookkeeper, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(hooked::step_setter, myriad::cash_karp)
MYRIAD_INSTANTIATE(hooked::breaker, myriad::runge_kutta_4, myriad::cash_karp)
