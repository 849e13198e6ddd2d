// SPDX-License-Identifier: MIT
// Events and extrema on noisy paths, in double precision: what locates events lies in memory and out of line.
//
// limit: integrate_ensemble<walled, euler_maruyama> registers 176 stack 704 spill 64
// limit: integrate_ensemble<growing, milstein> registers 176 stack 680 spill 0
// limit: integrate_ensemble<wandering, euler_maruyama> registers 120 stack 0 spill 0

#include <myriad/cuda/kernel.cuh>
#include <myriad/methods.hpp>
#include <myriad/model.hpp>

#include "tests/support/noisy_events.hpp"

constexpr auto constant = myriad::shared_placement::constant_bank;
#define INSTANTIATE(Model, Method)                                                                        \
    template __global__ void myriad::detail::integrate_ensemble<Model, myriad::Method, double, constant>( \
        const __grid_constant__ myriad::detail::launch_arguments<Model, double, constant>);
INSTANTIATE(noisy::walled, euler_maruyama)
INSTANTIATE(noisy::growing, milstein)
INSTANTIATE(noisy::wandering, euler_maruyama)
