// SPDX-License-Identifier: MIT
// Models with delays: alone, with sensitivities by their parameters, and of so many units that loops over their delayed
// values are not written out.
//
// limit: integrate_ensemble<jumping, dormand_prince_5> registers 96 stack 64 spill 64
// limit: integrate_ensemble<smooth_by_parameters, runge_kutta_4> registers 168 stack 96 spill 480
// limit: integrate_ensemble<coupled_units<delayed_units::phase, 20>, runge_kutta_4> registers 168 stack 10496 spill 24000

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
