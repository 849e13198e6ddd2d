// SPDX-License-Identifier: MIT
// Compiles the kernels of this problem.
#include <myriad/instantiate.hpp>

#include "../methods.hpp"
#include "van_der_pol.hpp"

#define VALIDATION_KERNEL(M) MYRIAD_INSTANTIATE(validation::van_der_pol, myriad::dense<myriad::M>)
VALIDATED_METHODS(VALIDATION_KERNEL)
