// SPDX-License-Identifier: MIT
// Compiles, in packs, the kernels of the model of metamorphic_models.hpp.
#include "metamorphic_models.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(metamorphic, myriad::tsitouras_5, myriad::cash_karp)
MYRIAD_INSTANTIATE_FLOAT(metamorphic, myriad::tsitouras_5)
