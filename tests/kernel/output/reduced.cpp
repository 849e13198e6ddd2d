// SPDX-License-Identifier: MIT
// The kernels of models with reductions.
#include "tests/kernel/output/reduced.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(reduced::plain_swing, myriad::runge_kutta_4, myriad::cash_karp, myriad::tsitouras_5,
                   myriad::dense<myriad::dormand_prince_8>)
MYRIAD_INSTANTIATE(reduced::swing, myriad::runge_kutta_4, myriad::cash_karp, myriad::tsitouras_5,
                   myriad::dormand_prince_5, myriad::verner_7, myriad::dormand_prince_8, myriad::rosenbrock_23,
                   myriad::rodas_5p)
MYRIAD_INSTANTIATE(reduced::swing, myriad::dense<myriad::cash_karp>)
MYRIAD_INSTANTIATE_FLOAT(reduced::swing, myriad::cash_karp, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(reduced::peak_of_swing, myriad::cash_karp, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(reduced::timed, myriad::tsitouras_5, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(reduced::ball, myriad::runge_kutta_4, myriad::cash_karp, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(reduced::remembering, myriad::cash_karp, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(reduced::remembering_by_hook, myriad::cash_karp, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(reduced::swing_with_tangents, myriad::tsitouras_5)
