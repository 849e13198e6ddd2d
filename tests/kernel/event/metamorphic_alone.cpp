// SPDX-License-Identifier: MIT
// Compiles the kernel of the model of metamorphic_models.hpp that integrates one instance at a time.
#include <myriad/instantiate.hpp>

#include "metamorphic_models.hpp"

MYRIAD_INSTANTIATE(metamorphic_alone, myriad::tsitouras_5)
