// SPDX-License-Identifier: MIT
// Extrema and integrals along the solution in CUDA kernels.
//
// limit: integrate_ensemble<damped, runge_kutta_4> stack 0 spill 0
// limit: integrate_ensemble<damped, cash_karp> stack 48 spill 80
// limit: integrate_ensemble<damped, tsitouras_5> stack 0 spill 0
// limit: integrate_ensemble<damped, rodas_5p> stack 0 spill 0

#include <myriad/cuda/kernel.cuh>
#include <myriad/methods.hpp>

#include "examples/hooks/models.hpp"

constexpr auto constant = myriad::shared_placement::constant_bank;

#define INSTANTIATE(Method)                                                                                \
    template __global__ void myriad::detail::integrate_ensemble<damped, myriad::Method, double, constant>( \
        const __grid_constant__ myriad::detail::launch_arguments<damped, double, constant>);
INSTANTIATE(runge_kutta_4)
INSTANTIATE(cash_karp)
INSTANTIATE(tsitouras_5)
INSTANTIATE(rodas_5p)
