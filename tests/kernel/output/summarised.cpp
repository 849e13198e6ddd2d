// SPDX-License-Identifier: MIT
// The kernels of models with summaries.
#include "tests/kernel/output/summarised.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(summarised::plain_swing, myriad::runge_kutta_4, myriad::cash_karp, myriad::tsitouras_5,
                   myriad::dense<myriad::dormand_prince_8>)
MYRIAD_INSTANTIATE(summarised::swing, myriad::runge_kutta_4, myriad::cash_karp, myriad::tsitouras_5,
                   myriad::dormand_prince_5, myriad::verner_7, myriad::dormand_prince_8, myriad::rosenbrock_23,
                   myriad::rodas_5p)
MYRIAD_INSTANTIATE(summarised::swing, myriad::dense<myriad::cash_karp>)
MYRIAD_INSTANTIATE_FLOAT(summarised::swing, myriad::cash_karp, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(summarised::peak_of_swing, myriad::cash_karp, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(summarised::timed, myriad::tsitouras_5, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(summarised::ball, myriad::runge_kutta_4, myriad::cash_karp, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(summarised::remembering, myriad::cash_karp, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(summarised::remembering_by_hook, myriad::cash_karp, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(summarised::halved, myriad::cash_karp, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(summarised::halved_and_summed, myriad::cash_karp, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(summarised::swing_with_tangents, myriad::tsitouras_5)
