// SPDX-License-Identifier: MIT
// Kernels of the library as AMD's GPUs would have them (gpu/hip.hpp): every kind of method, events, stop times,
// couplings of one thread and of teams, single precision, the sorts and the studies. Compiled, and never run.
#include <myriad/cuda/cost_order_kernels.cuh>
#include <myriad/cuda/kernel.cuh>
#include <myriad/cuda/study_kernels.cuh>
#include <myriad/methods.hpp>
#include <myriad/model.hpp>

#include "examples/bubble_cluster/cluster.hpp"
#include "examples/duffing/duffing.hpp"
#include "examples/hooks/models.hpp"
#include "problems/lorenz.hpp"
#include "problems/van_der_pol_ring.hpp"
#include "tests/kernel/model/teams.hpp"

using namespace myriad;
using shared_placement::cache, shared_placement::constant_bank;

#define INSTANTIATE(Model, Method, R, placement)                                      \
    template __global__ void detail::integrate_ensemble<Model, Method, R, placement>( \
        const __grid_constant__ detail::launch_arguments<Model, R, placement>);
using problems::lorenz;
using ring = problems::van_der_pol_ring<32>;
using part_of_a_warp = detail::model_of_thread<teams::places<8>, tsitouras_5, double>;
using part_of_a_block = detail::part_of_units<bubble_cluster, 128>;
INSTANTIATE(lorenz, runge_kutta_4, double, constant_bank)
INSTANTIATE(lorenz, tsitouras_5, float, constant_bank)
INSTANTIATE(duffing, cash_karp, double, constant_bank)
INSTANTIATE(damped, dormand_prince_8, double, constant_bank)
INSTANTIATE(bouncing_ball, dense<tsitouras_5>, double, constant_bank)
INSTANTIATE(dosing, tsitouras_5, double, constant_bank)
INSTANTIATE(damped, rodas_5p, double, constant_bank)
INSTANTIATE(ring, rosenbrock_23, double, constant_bank)
INSTANTIATE(part_of_a_warp, tsitouras_5, double, constant_bank)
INSTANTIATE(part_of_a_block, cash_karp, double, cache)
template __global__ void detail::fill_components<>(const fill_arguments);
template __global__ void detail::reduce_values<>(const reduce_arguments);
