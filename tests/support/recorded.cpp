// SPDX-License-Identifier: MIT
// Compiles the kernels of test problems whose steps are logged.
#include <myriad/instantiate.hpp>

#include "tests/support/problems.hpp"
#include "tests/support/recorder.hpp"

MYRIAD_INSTANTIATE(recorder::recorded<problems::log_circle>, myriad::cash_karp, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(recorder::recorded<problems::uniform>, myriad::runge_kutta_4, myriad::cash_karp, myriad::tsitouras_5)
MYRIAD_INSTANTIATE_FLOAT(recorder::recorded<problems::uniform>, myriad::runge_kutta_4, myriad::cash_karp,
                         myriad::tsitouras_5)
MYRIAD_INSTANTIATE(recorder::recorded<problems::oscillator>, myriad::runge_kutta_4, myriad::cash_karp,
                   myriad::tsitouras_5)
