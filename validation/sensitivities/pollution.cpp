// SPDX-License-Identifier: MIT
// Compiles the kernel with the most states beside the others.
#include <myriad/instantiate.hpp>

#include "validation/sensitivities/models.hpp"

MYRIAD_INSTANTIATE(validation::pollution_by, myriad::rodas_5p)
