// SPDX-License-Identifier: MIT
// Compiles the kernels of the models for the tests of first steps.
#include "first_step_models.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(first_steps::line, myriad::cash_karp, myriad::rosenbrock_23)
MYRIAD_INSTANTIATE_FLOAT(first_steps::line, myriad::cash_karp)
MYRIAD_INSTANTIATE(first_steps::pulses, myriad::cash_karp, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(first_steps::swing, myriad::tsitouras_5)
MYRIAD_INSTANTIATE_FLOAT(first_steps::swing, myriad::tsitouras_5)
MYRIAD_INSTANTIATE_FLOAT(first_steps::relaxation, myriad::tsitouras_5)
