// SPDX-License-Identifier: MIT
// Single precision stays single: no double arithmetic in the kernels of float models, including adaptive ones, events,
// hooks and dense output. (Trigonometric functions are excluded: CUDA's own reduction of large arguments is in double.)
//
//
// forbid: f64 in integrate_ensemble
// limit: integrate_ensemble<lorenz, runge_kutta_4> stack 0 spill 0 registers 48
// limit: integrate_ensemble<bouncer, cash_karp> registers 56 stack 416 spill 108
// limit: integrate_ensemble<bouncer, dense<tsitouras_5>> registers 80 stack 424 spill 128

#include <myriad/cuda/kernel.cuh>
#include <myriad/methods.hpp>
#include <myriad/model.hpp>

#include "problems/lorenz.hpp"

using problems::lorenz;

struct bouncer {
    enum state { height, speed, n_state };
    enum parameter { bounce, n_parameter };
    enum shared { gravity, n_shared };
    enum accessory { highest, n_accessory };
    enum event { floor, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        using myriad::exp, myriad::sqrt;
        return {s[speed], -p.shared[gravity] * exp(-s[height]) * sqrt(s[height] * s[height] + R(1))};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return {s[height]};
    }
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        lane.accessory[highest] = myriad::max(lane.accessory[highest], lane.y[height]);
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.y[speed] = -lane.parameter[bounce] * lane.y[speed];
    }
};

constexpr auto constant = myriad::shared_placement::constant_bank;
#define INSTANTIATE(Model, Method)                                                                       \
    template __global__ void myriad::detail::integrate_ensemble<Model, myriad::Method, float, constant>( \
        const __grid_constant__ myriad::detail::launch_arguments<Model, float, constant>);
INSTANTIATE(lorenz, runge_kutta_4)
INSTANTIATE(lorenz, tsitouras_5)
INSTANTIATE(bouncer, cash_karp)
INSTANTIATE(bouncer, dense<myriad::tsitouras_5>)
