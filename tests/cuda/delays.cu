// SPDX-License-Identifier: MIT
// Models with delays: alone, with sensitivities by their parameters, of so many units that loops over their delayed
// values are not written out, and of units that a team of threads integrates.
//
// limit: integrate_ensemble<jumping, dormand_prince_5> registers 96 stack 40 spill 0
// limit: integrate_ensemble<smooth_by_parameters, runge_kutta_4> registers 204 stack 0 spill 0
// limit: integrate_ensemble<coupled_units<delayed_units::phase, 20>, runge_kutta_4> registers 168 stack 13312 spill 52480
// limit: integrate_ensemble<part_of_units<coupled_units<delayed_units::phase, 64>, 32>, dormand_prince_5> registers 234 stack 40 spill 0

#include <myriad/cuda/kernel.cuh>
#include <myriad/methods.hpp>
#include <myriad/sensitivity.hpp>

#include "tests/kernel/model/delayed_units.hpp"
#include "tests/kernel/model/varied_past_models.hpp"

constexpr auto constant = myriad::shared_placement::constant_bank;
template __global__ void
myriad::detail::integrate_ensemble<varied::jumping, myriad::dormand_prince_5, double, constant>(
    const __grid_constant__ myriad::detail::launch_arguments<varied::jumping, double, constant>);
struct smooth_by_parameters : myriad::with_sensitivities<varied::smooth, varied::smooth::tau, varied::smooth::a> {};
template __global__ void
myriad::detail::integrate_ensemble<smooth_by_parameters, myriad::runge_kutta_4, double, constant>(
    const __grid_constant__ myriad::detail::launch_arguments<smooth_by_parameters, double, constant>);
template __global__ void
myriad::detail::integrate_ensemble<delayed_units::phases<20>, myriad::runge_kutta_4, double, constant>(
    const __grid_constant__ myriad::detail::launch_arguments<delayed_units::phases<20>, double, constant>);
using part_of_64 = myriad::detail::model_of_thread<delayed_units::phases<64>, myriad::dormand_prince_5, double>;
constexpr auto cache = myriad::shared_placement::cache;
template __global__ void myriad::detail::integrate_ensemble<part_of_64, myriad::dormand_prince_5, double, cache>(
    const __grid_constant__ myriad::detail::launch_arguments<part_of_64, double, cache>);
