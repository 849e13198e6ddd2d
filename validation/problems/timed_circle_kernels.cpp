// SPDX-License-Identifier: MIT
// Compiles the kernels of this problem.
#include <myriad/instantiate.hpp>

#include "../methods.hpp"
#include "timed_circle.hpp"

#define VALIDATION_KERNEL(M) MYRIAD_INSTANTIATE(validation::timed_circle, myriad::dense<myriad::M>)
VALIDATED_METHODS(VALIDATION_KERNEL)
VALIDATED_STIFF_METHODS(VALIDATION_KERNEL)
