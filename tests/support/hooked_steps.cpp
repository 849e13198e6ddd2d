// SPDX-License-Identifier: MIT
// Compiles the kernels of the models with hooks that set step sizes or do not return.
#include <myriad/instantiate.hpp>

#include "tests/support/hooked.hpp"

MYRIAD_INSTANTIATE(hooked::step_setter, myriad::cash_karp)
MYRIAD_INSTANTIATE(hooked::step_spoiler, myriad::cash_karp, myriad::runge_kutta_4, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(hooked::step_spoiler_generic, myriad::cash_karp, myriad::runge_kutta_4, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(hooked::breaker, myriad::runge_kutta_4, myriad::cash_karp)
