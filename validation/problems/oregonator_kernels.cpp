// SPDX-License-Identifier: MIT
// Compiles the kernels of this problem.
#include <myriad/instantiate.hpp>

#include "../methods.hpp"
#include "oregonator.hpp"

#define VALIDATION_KERNEL(M) MYRIAD_INSTANTIATE(validation::oregonator, myriad::dense<myriad::M>)
VALIDATED_STIFF_METHODS(VALIDATION_KERNEL)
