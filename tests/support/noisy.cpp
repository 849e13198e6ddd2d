// SPDX-License-Identifier: MIT
// The kernels of noisy.hpp.
#include "tests/support/noisy.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(noisy::solvable, myriad::euler_maruyama, myriad::milstein, myriad::stochastic_heun, myriad::sriw1,
                   myriad::linearly_implicit_euler_maruyama, myriad::dense<myriad::euler_maruyama>)
MYRIAD_INSTANTIATE_FLOAT(noisy::solvable, myriad::milstein)
MYRIAD_INSTANTIATE(noisy::solvable, myriad::adaptive<myriad::sriw1>)
MYRIAD_INSTANTIATE_FLOAT(noisy::solvable, myriad::adaptive<myriad::sriw1>)
MYRIAD_INSTANTIATE(noisy::quadratic, myriad::sriw1, myriad::adaptive<myriad::sriw1>)
MYRIAD_INSTANTIATE(noisy::interrupted, myriad::euler_maruyama, myriad::adaptive<myriad::sriw1>)
MYRIAD_INSTANTIATE(noisy::additive, myriad::sra1, myriad::adaptive<myriad::sra1>,
                   myriad::linearly_implicit_euler_maruyama)
MYRIAD_INSTANTIATE(noisy::sharing, myriad::euler_maruyama, myriad::dri1)
MYRIAD_INSTANTIATE(noisy::coupled_drift, myriad::sriw1)
