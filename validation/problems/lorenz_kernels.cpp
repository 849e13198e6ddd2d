// SPDX-License-Identifier: MIT
// Compiles the kernels of this problem.
#include <myriad/instantiate.hpp>

#include "../methods.hpp"
#include "lorenz.hpp"

#define VALIDATION_KERNEL(M) MYRIAD_INSTANTIATE(validation::lorenz, myriad::dense<myriad::M>)
VALIDATED_METHODS(VALIDATION_KERNEL)
#define VALIDATION_FLOAT_KERNEL(M) MYRIAD_INSTANTIATE_FLOAT(validation::lorenz, myriad::dense<myriad::M>)
VALIDATED_FLOAT_METHODS(VALIDATION_FLOAT_KERNEL)
MYRIAD_INSTANTIATE(validation::lorenz_tangent, myriad::tsitouras_5)
