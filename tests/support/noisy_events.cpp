// SPDX-License-Identifier: MIT
// The kernels of noisy_events.hpp.
#include "tests/support/noisy_events.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(noisy::walled, myriad::euler_maruyama, myriad::sra1, myriad::dense<myriad::euler_maruyama>)
MYRIAD_INSTANTIATE_FLOAT(noisy::walled, myriad::euler_maruyama)
MYRIAD_INSTANTIATE(noisy::in_a_disc, myriad::euler_maruyama)
MYRIAD_INSTANTIATE(noisy::bouncing, myriad::euler_maruyama, myriad::stochastic_heun)
MYRIAD_INSTANTIATE(noisy::wandering, myriad::euler_maruyama)
MYRIAD_INSTANTIATE(noisy::growing, myriad::milstein, myriad::sriw1)
