// SPDX-License-Identifier: MIT
// The kernels of a model with stop times, beside those of the same model without.
//
//
// limit: integrate_ensemble<dosing, tsitouras_5> stack 0 spill 0 registers 64
// limit: integrate_ensemble<dosing, runge_kutta_4> stack 0 spill 0 registers 72

#include <myriad/cuda/kernel.cuh>
#include <myriad/methods.hpp>
#include <myriad/model.hpp>

#include "examples/hooks/models.hpp"

/// Without doses.
struct untreated {
    enum state { gut, blood, n_state };
    enum parameter { ka, ke, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {-p[ka] * y[gut], p[ka] * y[gut] - p[ke] * y[blood]};
    }
};

constexpr auto constant = myriad::shared_placement::constant_bank;

#define INSTANTIATE(Model, Method)                                                                        \
    template __global__ void myriad::detail::integrate_ensemble<Model, myriad::Method, double, constant>( \
        const __grid_constant__ myriad::detail::launch_arguments<Model, double, constant>);
INSTANTIATE(dosing, tsitouras_5)
INSTANTIATE(dosing, runge_kutta_4)
INSTANTIATE(untreated, tsitouras_5)
INSTANTIATE(untreated, runge_kutta_4)
