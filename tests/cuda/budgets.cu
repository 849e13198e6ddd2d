// SPDX-License-Identifier: MIT
// The kernels of the benchmarks, with budgets for the resources that the compiler reports: one that exceeds its budget
// lets fewer threads run at once (65536 registers per multiprocessor, in steps of eight per thread) or begins to spill.
//
//
// limit: integrate_ensemble<lorenz_with<eight_thirds>, runge_kutta_4> registers 56 stack 0 spill 0
// limit: integrate_ensemble<lorenz_with<eight_thirds>, tsitouras_5> registers 80 stack 0 spill 0
// limit: integrate_ensemble<keller_miksis, cash_karp> registers 144 stack 0 spill 0
// limit: integrate_ensemble<keller_miksis, verner_7> registers 255 stack 0 spill 0
// limit: integrate_ensemble<keller_miksis, dormand_prince_8> registers 176 stack 0 spill 0
// limit: integrate_ensemble<relief_valve_model, cash_karp> registers 96 stack 864 spill 0
// limit: integrate_ensemble<relief_valve_model, verner_7> registers 96 stack 952 spill 448
// limit: integrate_ensemble<relief_valve_model, dormand_prince_8> registers 96 stack 936 spill 420
#include <myriad/cuda/kernel.cuh>
#include <myriad/methods.hpp>

#include "benchmarks/gpu_ensembles/models.hpp"

constexpr auto constant = myriad::shared_placement::constant_bank;

#define KERNEL(Model, Method)                                                                   \
    template __global__ void                                                                    \
    myriad::detail::integrate_ensemble<gpu_ensembles::Model, myriad::Method, double, constant>( \
        const __grid_constant__ myriad::detail::launch_arguments<gpu_ensembles::Model, double, constant>);
KERNEL(lorenz, runge_kutta_4)
KERNEL(lorenz, tsitouras_5)
KERNEL(keller_miksis, cash_karp)
KERNEL(keller_miksis, verner_7)
KERNEL(keller_miksis, dormand_prince_8)
KERNEL(relief_valve, cash_karp)
KERNEL(relief_valve, verner_7)
KERNEL(relief_valve, dormand_prince_8)
