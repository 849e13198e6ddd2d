// SPDX-License-Identifier: MIT
// The kernels of coupled units: a small system takes what the same system written as a whole takes; the parts of a
// team's threads are in registers, those of 30 states and those of 256, whose Jacobian is full; a team has hooks,
// events, extrema and integrals, and accessories and parameters that hooks write.
//
// limit: integrate_ensemble<coupled_units<oscillator, 4>, cash_karp> stack 40 spill 0 registers_within 1.05 of integrate_ensemble<whole_ring<4>, cash_karp>
// limit: integrate_ensemble<part_of_units<coupled_units<of_team<place, 8>, 30>, 8>, tsitouras_5> stack 0 spill 0 registers 128
// limit: integrate_ensemble<part_of_units<coupled_units<cluster_bubble, 128>, 32>, cash_karp> stack 0 spill 0

#include <myriad/cuda/kernel.cuh>
#include <myriad/methods.hpp>
#include <myriad/model.hpp>

#include "examples/bubble_cluster/cluster.hpp"
#include "tests/kernel/model/teams.hpp"

#define INSTANTIATE(Model, Method, placement)                                                               \
    template __global__ void                                                                                \
    myriad::detail::integrate_ensemble<Model, myriad::Method, double, myriad::shared_placement::placement>( \
        const __grid_constant__ myriad::detail::launch_arguments<Model, double, myriad::shared_placement::placement>);
using small = units::ring<4>;
using small_as_a_whole = units::whole_ring<4>;
using part_of_30 = myriad::detail::model_of_thread<teams::places<8>, myriad::tsitouras_5, double>;
using part_with_hooks = myriad::detail::model_of_thread<teams::hoppers<16>, myriad::cash_karp, double>;
using part_that_observes = myriad::detail::model_of_thread<teams::watched_ring<8>, myriad::cash_karp, double>;
using part_that_adapts = myriad::detail::model_of_thread<teams::adapting_cells<8>, myriad::cash_karp, double>;
using part_of_256 = myriad::detail::model_of_thread<bubble_cluster, myriad::cash_karp, double>;
// One thread has a large trial step in shared memory; a team has that memory for itself, however large the step.
using part_of_512 =
    myriad::detail::model_of_thread<myriad::coupled_units<teams::place, 512>, myriad::dormand_prince_8, double>;
static_assert(myriad::detail::shared_step_bytes<myriad::tsitouras_5, teams::places<1>, double> > 0);
static_assert(myriad::detail::shared_step_bytes<myriad::dormand_prince_8, part_of_512, double> == 0);
// nvcc finds what a class template declares in arrays.
template <int>
struct in_template {
    enum publication { level, n_publication };
    enum observed { height, n_observed };
    enum accessory { highest, n_accessory };
    static constexpr myriad::coupling couplings[] = {myriad::full_coupling(level)};
    static constexpr myriad::summary summaries[] = {{height, myriad::over_phase::maximum, highest}};
};
static_assert(myriad::detail::n_coupling<in_template<0>> == 1 && myriad::detail::n_summary<in_template<0>> == 1);
INSTANTIATE(small, cash_karp, constant_bank)
INSTANTIATE(small_as_a_whole, cash_karp, constant_bank)
INSTANTIATE(part_of_30, tsitouras_5, constant_bank)
INSTANTIATE(part_that_observes, cash_karp, constant_bank)
#if defined(MYRIAD_THOROUGH)
INSTANTIATE(part_with_hooks, cash_karp, constant_bank)
INSTANTIATE(part_that_adapts, cash_karp, constant_bank)
#endif
INSTANTIATE(part_of_256, cash_karp, cache)
