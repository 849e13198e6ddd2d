// SPDX-License-Identifier: MIT
// Compiles the kernels of the stiff test problems.
#include "tests/support/stiff.hpp"

#include <myriad/instantiate.hpp>

#include "tests/support/faulty.hpp"

#define STIFF_METHODS myriad::rosenbrock_23, myriad::rodas_5p

MYRIAD_INSTANTIATE(stiff::robertson, STIFF_METHODS)
MYRIAD_INSTANTIATE(stiff::robertson_with_jacobian, myriad::rodas_5p)
MYRIAD_INSTANTIATE(stiff::van_der_pol, STIFF_METHODS)
MYRIAD_INSTANTIATE(stiff::growth, STIFF_METHODS)
MYRIAD_INSTANTIATE_FLOAT(stiff::growth, myriad::rodas_5p)
MYRIAD_INSTANTIATE(stiff::draining, myriad::rodas_5p)
MYRIAD_INSTANTIATE(faulty::clock_fault, myriad::rosenbrock_23)
MYRIAD_INSTANTIATE(stiff::rod<7>, myriad::rodas_5p)
MYRIAD_INSTANTIATE(stiff::rod<32>, myriad::rodas_5p)
MYRIAD_INSTANTIATE_FLOAT(stiff::rod<32>, myriad::rosenbrock_23)
