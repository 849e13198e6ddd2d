// SPDX-License-Identifier: MIT
// The kernels of coupled units: a small system takes what the same system written as a whole takes, and one of 256
// states, whose Jacobian is full, compiles, in local memory.
//
// limit: integrate_ensemble<coupled_units<oscillator, 4>, cash_karp> stack 40 spill 0 registers_within 1.05 of integrate_ensemble<whole_ring<4>, cash_karp>
// limit: integrate_ensemble<coupled_units<cluster_bubble, 128>, cash_karp> stack 40000 spill 45000 registers 168

#include <myriad/cuda/kernel.cuh>
#include <myriad/methods.hpp>
#include <myriad/model.hpp>

#include "examples/bubble_cluster/cluster.hpp"
#include "tests/kernel/model/unit_models.hpp"

#define INSTANTIATE(Model, placement)                                                                          \
    template __global__ void                                                                                   \
    myriad::detail::integrate_ensemble<Model, myriad::cash_karp, double, myriad::shared_placement::placement>( \
        const __grid_constant__ myriad::detail::launch_arguments<Model, double, myriad::shared_placement::placement>);
using small = units::ring<4>;
using small_as_a_whole = units::whole_ring<4>;
INSTANTIATE(small, constant_bank)
INSTANTIATE(small_as_a_whole, constant_bank)
INSTANTIATE(bubble_cluster, cache)
