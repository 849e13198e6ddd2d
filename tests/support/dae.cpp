// SPDX-License-Identifier: MIT
// Compiles the kernels of differential-algebraic equations.
#include "tests/support/dae.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(dae::robertson, myriad::rodas_5p)
MYRIAD_INSTANTIATE_FLOAT(dae::robertson, myriad::rodas_5p)
MYRIAD_INSTANTIATE(dae::transistor_amplifier, myriad::rodas_5p)
MYRIAD_INSTANTIATE(dae::crossed<4>, myriad::dense<myriad::rodas_5p>)
MYRIAD_INSTANTIATE(dae::crossed<9>, myriad::rodas_5p)
MYRIAD_INSTANTIATE(dae::straight<9>, myriad::rodas_5p)
MYRIAD_INSTANTIATE(dae::pendulum, myriad::rodas_5p)
MYRIAD_INSTANTIATE(dae::levelled, myriad::rodas_5p)
