// SPDX-License-Identifier: MIT
// Kernels of heavy right-hand sides have one copy of it: with a copy in each of the seven places where one of
// dormand_prince_5 is evaluated, they had 100, 447 and 219 kB of instructions, of which a multiprocessor keeps some
// 128.
//
// limit: integrate_ensemble<hodgkin_huxley, dormand_prince_5, double> code 40000 registers 168 stack 0 spill 0
// limit: integrate_ensemble<kuramoto<32>, dormand_prince_5, double> code 200000
// limit: integrate_ensemble<kuramoto<8>, dormand_prince_5, float> code 60000
#include <myriad/cuda/kernel.cuh>
#include <myriad/methods.hpp>

#include "problems/hodgkin_huxley.hpp"
#include "problems/kuramoto.hpp"

constexpr auto constant = myriad::shared_placement::constant_bank;

#define KERNEL(Model, R)                                                                                       \
    template __global__ void myriad::detail::integrate_ensemble<Model, myriad::dormand_prince_5, R, constant>( \
        const __grid_constant__ myriad::detail::launch_arguments<Model, R, constant>);
KERNEL(problems::hodgkin_huxley, double)
KERNEL(problems::kuramoto<32>, double)
KERNEL(problems::kuramoto<8>, float)
