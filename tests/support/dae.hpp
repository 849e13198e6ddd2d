// SPDX-License-Identifier: MIT
// Differential-algebraic equations M y' = f of index one: with a conservation law, an electric circuit whose mass
// matrix is not diagonal, and equations that do not contain their own state.
#pragma once

#include <array>
#include <cstddef>

#include <myriad/model.hpp>

namespace dae {

/// Robertson's reactions, the third of which is replaced by the sum of the concentrations.
struct robertson {
    enum state { a, b, c, n_state };
    static constexpr myriad::mass_entry mass_matrix[] = {{a, a, 1}, {b, b, 1}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        using real = myriad::real_of<R>;
        const R slow = real(0.04) * y[a], back = real(1e4) * y[b] * y[c], fast = real(3e7) * y[b] * y[b];
        return {back - slow, slow - back - fast, y[a] + y[b] + y[c] - real(1)};
    }
};

/// A transistor amplifier of eight nodes (Hairer, Lubich and Roche, The Numerical Solution of Differential-Algebraic
/// Systems by Runge-Kutta Methods, 1989, p. 108), problem TRANSAMP of the Test Set for IVP Solvers.
struct transistor_amplifier {
    enum state { u1, u2, u3, u4, u5, u6, u7, u8, n_state };
    static constexpr myriad::mass_entry mass_matrix[] = {
        {u1, u1, -1e-6}, {u1, u2, 1e-6}, {u2, u1, 1e-6}, {u2, u2, -1e-6}, {u3, u3, -2e-6},
        {u4, u4, -3e-6}, {u4, u5, 3e-6}, {u5, u4, 3e-6}, {u5, u5, -3e-6}, {u6, u6, -4e-6},
        {u7, u7, -5e-6}, {u7, u8, 5e-6}, {u8, u7, 5e-6}, {u8, u8, -5e-6}};

    template <class R>
    MYRIAD_FUNCTION static R through(const R& voltage) {
        return 1e-6 * (myriad::exp(voltage / 0.026) - 1.0);
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& u, const auto&) {
        const R input(0.1 * myriad::sinpi(200.0 * t)), supply(6), resistance(9000);
        const R first = through<R>(u[u2] - u[u3]), second = through<R>(u[u5] - u[u6]);
        return {(u[u1] - input) / 1000.0,
                u[u2] / resistance + (u[u2] - supply) / resistance + 0.01 * first,
                u[u3] / resistance - first,
                (u[u4] - supply) / resistance + 0.99 * first,
                u[u5] / resistance + (u[u5] - supply) / resistance + 0.01 * second,
                u[u6] / resistance - second,
                (u[u7] - supply) / resistance + 0.99 * second,
                u[u8] / resistance};
    }
};

/// n - 2 states that follow sin t, and two algebraic equations, each of which contains only the other one's state, so
/// that the diagonal has no entry for them: y_i' = z - y_i + cos t, 0 = w - z^2, 0 = z - sin t.
template <int n>
struct crossed {
    enum state { first, z = n - 2, w, n_state = n };
    static constexpr auto mass_matrix = [] {
        std::array<myriad::mass_entry, n - 2> all{};
        for (int i = 0; i < n - 2; ++i) all[static_cast<std::size_t>(i)] = {i, i, 1};
        return all;
    }();

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n> rhs(auto t, const myriad::vec<R, n>& y, const auto&) {
        myriad::vec<R, n> f;
        for (int i = 0; i < n - 2; ++i) f[i] = y[z] - y[i] + R(myriad::cos(t));
        f[z] = y[w] - y[z] * y[z];
        f[w] = y[z] - R(myriad::sin(t));
        return f;
    }
};

/// The same with the two algebraic equations exchanged, each in the row of its own state, and scaled.
template <int n>
struct straight : crossed<n> {
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n> rhs(auto t, const myriad::vec<R, n>& y, const auto& p) {
        auto f = crossed<n>::template rhs<R>(t, y, p);
        const R for_w = f[n - 2];
        f[n - 2] = 1e6 * f[n - 1];
        f[n - 1] = for_w;
        return f;
    }
};

/// x' = y and 0 = cubic y^3 + quadratic y^2 + linear y - level. The level is another one from t = 1 on, and where x
/// comes to 1/2.
struct levelled {
    enum state { x, y, n_state };
    enum parameter { cubic, quadratic, linear, from_1_on, from_event_on, n_parameter };
    enum accessory { level, n_accessory };
    enum event { reached, n_event };
    enum stop { rises, n_stop };
    static constexpr myriad::mass_entry mass_matrix[] = {{x, x, 1}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {s[y], ((p[cubic] * s[y] + p[quadratic]) * s[y] + p[linear]) * s[y] - p.accessory[level]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return myriad::vec<R, n_event>{s[x] - 0.5};
    }
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, int number, const auto&) {
        return number == 0 ? R(1) : myriad::infinity_of<R>;
    }
    MYRIAD_FUNCTION static void after_stop(int, int, auto& lane) { lane.accessory[level] = lane.parameter[from_1_on]; }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) { lane.accessory[level] = lane.parameter[from_event_on]; }
};

/// A pendulum in Cartesian coordinates with the force of its rod, which the length determines only after two
/// differentiations: of index three.
struct pendulum {
    enum state { x, y, u, v, force, n_state };
    static constexpr myriad::mass_entry mass_matrix[] = {{x, x, 1}, {y, y, 1}, {u, u, 1}, {v, v, 1}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return {s[u], s[v], -s[force] * s[x], -s[force] * s[y] - 9.81, s[x] * s[x] + s[y] * s[y] - 1.0};
    }
};

}  // namespace dae
