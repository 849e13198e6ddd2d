// SPDX-License-Identifier: MIT
// Compiles the kernels of stiff problems that depend on time, of those that show the orders, and of one with all hooks,
// events and samples.
#include <myriad/instantiate.hpp>

#include "tests/support/problems.hpp"
#include "tests/support/stiff.hpp"

#define STIFF_METHODS myriad::rosenbrock_23, myriad::rodas_5p

MYRIAD_INSTANTIATE(problems::timed_circle, STIFF_METHODS)
MYRIAD_INSTANTIATE_FLOAT(problems::oscillator, STIFF_METHODS)
MYRIAD_INSTANTIATE(stiff::prothero_robinson, STIFF_METHODS, myriad::tsitouras_5, myriad::dormand_prince_8)
MYRIAD_INSTANTIATE(stiff::relay, myriad::dense<myriad::rosenbrock_23>, myriad::dense<myriad::rodas_5p>)
