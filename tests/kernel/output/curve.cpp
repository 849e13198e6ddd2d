// SPDX-License-Identifier: MIT
// Compiles the kernels, with and without dense output, of the model with an exact solution.
#include <myriad/instantiate.hpp>

#include "tests/kernel/output/models.hpp"

MYRIAD_INSTANTIATE(output::curve, myriad::runge_kutta_4, myriad::cash_karp, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(output::curve, myriad::dense<myriad::runge_kutta_4>, myriad::dense<myriad::cash_karp>,
                   myriad::dense<myriad::tsitouras_5>)
MYRIAD_INSTANTIATE(output::curve, myriad::dense<myriad::dormand_prince_8>)
#if defined(MYRIAD_NIGHTLY)
MYRIAD_INSTANTIATE(output::curve, myriad::dense<myriad::dormand_prince_5>, myriad::dense<myriad::verner_7>)
#endif
MYRIAD_INSTANTIATE_FLOAT(output::curve, myriad::dense<myriad::runge_kutta_4>, myriad::dense<myriad::cash_karp>,
                         myriad::dense<myriad::tsitouras_5>)
