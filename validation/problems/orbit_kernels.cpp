// SPDX-License-Identifier: MIT
// Compiles the kernels of this problem, in both precisions.
#include <myriad/instantiate.hpp>

#include "../methods.hpp"
#include "kepler.hpp"

#define VALIDATION_KERNEL(M) MYRIAD_INSTANTIATE(validation::orbit, myriad::M)
VALIDATED_METHODS(VALIDATION_KERNEL)
VALIDATED_STIFF_METHODS(VALIDATION_KERNEL)
#undef VALIDATION_KERNEL
#define VALIDATION_KERNEL(M) MYRIAD_INSTANTIATE_FLOAT(validation::orbit, myriad::M)
VALIDATED_METHODS(VALIDATION_KERNEL)
VALIDATED_STIFF_METHODS(VALIDATION_KERNEL)
