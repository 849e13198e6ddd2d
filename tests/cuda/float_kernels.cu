// SPDX-License-Identifier: MIT
// Single precision stays single: no double arithmetic in the kernels of float models, including adaptive ones, events,
// hooks and dense output; and elementary functions and quotients need no local memory.
//
//
// forbid: f64 in integrate_ensemble
// limit: integrate_ensemble<lorenz, runge_kutta_4> stack 0 spill 0 registers 48
// limit: integrate_ensemble<bouncer, cash_karp> registers 56 stack 440 spill 136
// limit: integrate_ensemble<bouncer, dense<tsitouras_5>> registers 80 stack 400 spill 0
// limit: integrate_ensemble<waves, runge_kutta_4> stack 0 spill 0
// limit: integrate_ensemble<sharing, euler_maruyama> registers 88 stack 0 spill 0

#include <myriad/cuda/kernel.cuh>
#include <myriad/methods.hpp>
#include <myriad/model.hpp>

#include "problems/lorenz.hpp"
#include "tests/support/noisy.hpp"

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

struct waves {
    enum state { phase, size, n_state };
    enum parameter { rate, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        using myriad::cos, myriad::log, myriad::pow, myriad::sin, myriad::tan;
        return {p[rate] / (R(1) + sin(y[phase])) + tan(y[size]),
                pow(y[size], p[rate]) * cos(y[phase] + t) - log(y[size])};
    }
};

constexpr auto constant = myriad::shared_placement::constant_bank;
#define INSTANTIATE(Model, Method)                                                                       \
    template __global__ void myriad::detail::integrate_ensemble<Model, myriad::Method, float, constant>( \
        const __grid_constant__ myriad::detail::launch_arguments<Model, float, constant>);
INSTANTIATE(lorenz, runge_kutta_4)
INSTANTIATE(lorenz, tsitouras_5)
INSTANTIATE(waves, runge_kutta_4)
INSTANTIATE(noisy::sharing, euler_maruyama)
INSTANTIATE(bouncer, cash_karp)
INSTANTIATE(bouncer, dense<myriad::tsitouras_5>)
