// SPDX-License-Identifier: MIT
// Equations with delays as they were timed on GPUs and CPUs before: D. Nagy, L. Plavecz, F. Hegedus, the repository
// nnagyd/DDE_solver_tests on GitHub, from which parameters, initial values and histories are.
#pragma once

#include <myriad/model.hpp>

namespace problems {

// snippet: mackey_glass
/// Mackey and Glass's equation of blood cells, Science 197 (1977) 287-289: their production answers a while later.
struct mackey_glass {
    enum state { x, n_state };
    enum parameter { beta, gamma, n, tau, n_parameter };
    enum delayed { x_before, n_delayed };  // values of the past that the model reads

    MYRIAD_FUNCTION static int delayed_state(int) { return x; }  // the state that each is of
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const auto& p) {  // and how long ago
        return p[tau];
    }
    template <class R>
    MYRIAD_FUNCTION static R history(int, const R&, const auto&) {  // before t_begin
        return R(0.5);
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        const R before = p.delayed[x_before];
        return {p[beta] * before / (R(1) + myriad::pow(before, p[n])) - p[gamma] * y[x]};
    }
};
// end of snippet

/// Lorenz's equations whose first sees the second state 13/28 ago. History y = -8 + sin(2 pi t).
struct delayed_lorenz {
    enum state { x, y, z, n_state };
    enum parameter { r, n_parameter };
    enum delayed { y_before, n_delayed };

    MYRIAD_FUNCTION static int delayed_state(int) { return y; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const auto&) {
        return R(13.0 / 28.0);
    }
    template <class R>
    MYRIAD_FUNCTION static R history(int, const R& t, const auto&) {
        using myriad::sin;
        return sin(R(6.283185307179586) * t) - R(8);
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {R(10) * (p.delayed[y_before] - s[x]), p[r] * s[x] - s[y] - s[z] * s[x],
                s[x] * s[y] - R(8.0 / 3.0) * s[z]};
    }
};

/// The logistic equation with one delay, x' = x (p - x(t - 1)). History 1.5 - cos t.
struct delayed_logistic {
    enum state { x, n_state };
    enum parameter { r, n_parameter };
    enum delayed { x_before, n_delayed };

    MYRIAD_FUNCTION static int delayed_state(int) { return x; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const auto&) {
        return R(1);
    }
    template <class R>
    MYRIAD_FUNCTION static R history(int, const R& t, const auto&) {
        using myriad::cos;
        return R(1.5) - cos(t);
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {s[x] * (p[r] - p.delayed[x_before])};
    }
};

/// With two delays, x' = x x(t - 2) (p - x(t - 1)).
struct twice_delayed_logistic {
    enum state { x, n_state };
    enum parameter { r, n_parameter };
    enum delayed { one_before, two_before, n_delayed };

    MYRIAD_FUNCTION static int delayed_state(int) { return x; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int j, const auto&) {
        return R(j + 1);
    }
    template <class R>
    MYRIAD_FUNCTION static R history(int, const R& t, const auto&) {
        return t + R(0.5);
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {s[x] * p.delayed[two_before] * (p[r] - p.delayed[one_before])};
    }
};

/// A ball with a drag by its velocity a while ago, v' = -9.81, x' = v - d v(t - tau), which bounces with 0.95.
struct delayed_ball {
    enum state { v, x, n_state };
    enum parameter { drag, tau, n_parameter };
    enum integer_accessory { bounces, n_integer_accessory };
    enum event { floor, n_event };
    enum delayed { v_before, n_delayed };

    MYRIAD_FUNCTION static int delayed_state(int) { return v; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const auto& p) {
        return p[tau];
    }
    template <class R>
    MYRIAD_FUNCTION static R history(int, const R&, const auto&) {
        return R(0);
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {R(-9.81), s[v] - p[drag] * p.delayed[v_before]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return {s[x]};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.y[v] = -0.95 * lane.y[v];
        lane.integer_accessory[bounces] += 1;
    }
};

}  // namespace problems
