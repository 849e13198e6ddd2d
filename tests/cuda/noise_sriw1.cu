// SPDX-License-Identifier: MIT
// A method with integrals of several Wiener processes, more than a block has numbers for.
//
// limit: integrate_ensemble<solvable, sriw1> registers 176 stack 0 spill 0

#include <myriad/cuda/kernel.cuh>
#include <myriad/methods.hpp>
#include <myriad/model.hpp>

#include "tests/support/noisy.hpp"

constexpr auto constant = myriad::shared_placement::constant_bank;
template __global__ void myriad::detail::integrate_ensemble<noisy::solvable, myriad::sriw1, double, constant>(
    const __grid_constant__ myriad::detail::launch_arguments<noisy::solvable, double, constant>);
