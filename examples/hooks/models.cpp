// SPDX-License-Identifier: MIT
// Compiles the small models; one file may contain several, in double and single precision.
// snippet: instantiation
#include "models.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(bouncing_ball, myriad::cash_karp, myriad::tsitouras_5)
MYRIAD_INSTANTIATE_FLOAT(bouncing_ball, myriad::tsitouras_5)
// end of snippet
MYRIAD_INSTANTIATE(damped, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(tangent_duffing, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(settling, myriad::tsitouras_5)
MYRIAD_INSTANTIATE_FLOAT(settling, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(continuation, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(slow_valve, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(dosing, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(stop_by_select, myriad::tsitouras_5, myriad::dense<myriad::tsitouras_5>)
MYRIAD_INSTANTIATE(stop_by_branch, myriad::tsitouras_5)
