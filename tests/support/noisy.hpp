// SPDX-License-Identifier: MIT
// Stochastic equations whose solutions, or moments, are known.
#pragma once

#include <myriad/model.hpp>

namespace noisy {

/// Three equations beside each other, each with a Wiener process of its own and a solution that is a function of W, or
/// has known moments. `ito` is 1 for the Ito equations; with 0 they are Stratonovich's, with another drift and the same
/// solutions. With `bare` 1 all states are the Wiener processes themselves, and else 0.
struct solvable {
    enum state { growth, wide, decay, n_state };
    enum parameter { ito, bare, n_parameter };
    static constexpr double rate = 0.5, factor = 0.8, wideness = 0.7, damping = 1.5, force = 0.6;

    /// x = exp(a t + b W); x = sinh(c + b W); dx = -c x dt + s dW.
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        using T = myriad::real_of<R>;
        constexpr T of_growth = T(0.5 * factor * factor), of_wide = T(0.5 * wideness * wideness);
        const auto on = T(1) - p[bare];
        return {on * (T(rate) + of_growth * p[ito]) * y[growth], on * of_wide * p[ito] * y[wide],
                -T(damping) * on * y[decay]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> diffusion(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        using T = myriad::real_of<R>;
        const auto on = T(1) - p[bare];
        return {on * T(factor) * y[growth] + p[bare],
                on * T(wideness) * myriad::sqrt(T(1) + y[wide] * y[wide]) + p[bare], R(on * T(force) + p[bare])};
    }
};

/// The same with stop times at equal intervals, which add to a state, and a hook that counts steps.
struct interrupted : solvable {
    enum accessory { interval, steps, n_accessory };
    enum stop { addition, n_stop };

    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, int number, const auto& p) {
        return myriad::recurring(number, p.accessory[interval], p.accessory[interval], 1000);
    }
    MYRIAD_FUNCTION static void after_stop(int, int, auto& lane) { lane.y[decay] += 1; }
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        lane.accessory[steps] += 1;
    }
};

/// x = tanh(artanh(x(0)) - a t + b W), the stiffer the larger a and b are: near 1 it is left at the rate 2 (a + b^2).
struct quadratic {
    enum state { x, n_state };
    enum parameter { a, b, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        using T = myriad::real_of<R>;
        return myriad::vec<R, n_state>{-(p[a] + p[b] * p[b] * y[x]) * (T(1) - y[x] * y[x])};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> diffusion(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        using T = myriad::real_of<R>;
        return myriad::vec<R, n_state>{p[b] * (T(1) - y[x] * y[x])};
    }
};

/// Noise that does not depend on the states: x = (x(0) + b t + a b W) / sqrt(1 + t), and one drift that is
/// not linear.
struct additive {
    enum state { x, wave, n_state };
    static constexpr double a = 0.7, b = 0.9;

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto&) {
        using T = myriad::real_of<R>;
        const auto u = T(1) + t;
        return {T(b) / myriad::sqrt(u) - T(0.5) * y[x] / u, myriad::cos(T(4) * y[wave])};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> diffusion(auto t, const myriad::vec<R, n_state>&, const auto&) {
        using T = myriad::real_of<R>;
        return {R(T(a * b) / myriad::sqrt(T(1) + t)), R(T(1))};
    }
};

/// Diagonal noise and a drift that joins the states: x = W and dz = x z dt + c z dV, of which z is
/// z(0) exp(the integral of W + c V - c^2 t / 2). The third is a cubic drift with a factor that is not linear.
struct coupled_drift {
    enum state { x, z, cubic, n_state };
    static constexpr double c = 0.6;

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {R(0), y[x] * y[z], y[x] + y[cubic] - y[cubic] * y[cubic] * y[cubic]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> diffusion(auto, const myriad::vec<R, n_state>& y, const auto&) {
        using T = myriad::real_of<R>;
        return {R(1), T(c) * y[z], T(0.5) * myriad::cos(T(2) * y[cubic])};
    }
};

/// Two states that share two processes, whose noise does not commute; E x^2 = exp(-t) for x(0) = 1, as
/// 2 (-273 / 512) + 1 / 16 + 1 / 256 = -1. After Debrabant and Roessler, Appl. Numer. Math. 59 (2009) 582-594.
struct sharing {
    enum state { x, z, n_state };
    enum noise { first, second, n_noise };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        using T = myriad::real_of<R>;
        constexpr T own = T(-273.0 / 512), of_x = T(-1.0 / 160), of_z = T(-785.0 / 512 + 0.17677669529663689);
        return {own * y[x], of_x * y[x] + of_z * y[z]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<myriad::vec<R, n_noise>, n_state> diffusion(auto,
                                                                                   const myriad::vec<R, n_state>& y,
                                                                                   const auto&) {
        using T = myriad::real_of<R>;
        constexpr T of_z = T(-0.45710678118654752);  // (1 - 2 sqrt(2)) / 4
        return {myriad::vec<R, n_noise>{T(1.0 / 4) * y[x], T(1.0 / 16) * y[x]},
                myriad::vec<R, n_noise>{of_z * y[z], T(1.0 / 10) * y[x] + T(1.0 / 16) * y[z]}};
    }
};

}  // namespace noisy
