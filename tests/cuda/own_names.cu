// SPDX-License-Identifier: MIT
// A model whose file has functions of its own with the names of the library's internals, in CUDA kernels.
//
// limit: integrate_ensemble<strangely_named, runge_kutta_4> stack 760 spill 280 registers 80
// limit: integrate_ensemble<strangely_named, cash_karp> stack 728 spill 134 registers 80

#include <myriad/cuda/kernel.cuh>
#include <myriad/methods.hpp>

#include "tests/kernel/model/own_names.hpp"

constexpr auto constant = myriad::shared_placement::constant_bank;

#define INSTANTIATE(Method)                                                                                         \
    template __global__ void myriad::detail::integrate_ensemble<strangely_named, myriad::Method, double, constant>( \
        const __grid_constant__ myriad::detail::launch_arguments<strangely_named, double, constant>);
INSTANTIATE(runge_kutta_4)
INSTANTIATE(cash_karp)
