// SPDX-License-Identifier: MIT
// Compiles the kernels of the models whose right-hand side has no value beyond a state, by every kind of method.
#include <myriad/instantiate.hpp>

#include "tests/support/faulty.hpp"

MYRIAD_INSTANTIATE(faulty::open_cliff, myriad::cash_karp, myriad::tsitouras_5, myriad::dormand_prince_5,
                   myriad::verner_7, myriad::verner_9, myriad::dormand_prince_8, myriad::rosenbrock_23,
                   myriad::rodas_5p, faulty::midpoint_rule)
MYRIAD_INSTANTIATE_FLOAT(faulty::open_cliff, myriad::cash_karp, myriad::dormand_prince_8)
MYRIAD_INSTANTIATE(faulty::guarded, myriad::tsitouras_5)
