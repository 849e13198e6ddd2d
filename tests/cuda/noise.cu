// SPDX-License-Identifier: MIT
// Stochastic equations in double precision: more Wiener processes than a block has numbers for, integrals of one, and
// factors of single processes.
//
// limit: integrate_ensemble<solvable, milstein> registers 144 stack 0 spill 0
// limit: integrate_ensemble<additive, sra1> registers 152 stack 40 spill 0
// limit: integrate_ensemble<sharing, dri1> registers 128 stack 0 spill 0

#include <myriad/cuda/kernel.cuh>
#include <myriad/methods.hpp>
#include <myriad/model.hpp>

#include "tests/support/noisy.hpp"

constexpr auto constant = myriad::shared_placement::constant_bank;
#define INSTANTIATE(Model, Method)                                                                        \
    template __global__ void myriad::detail::integrate_ensemble<Model, myriad::Method, double, constant>( \
        const __grid_constant__ myriad::detail::launch_arguments<Model, double, constant>);
INSTANTIATE(noisy::solvable, milstein)
INSTANTIATE(noisy::additive, sra1)
INSTANTIATE(noisy::sharing, dri1)
