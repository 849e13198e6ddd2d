// SPDX-License-Identifier: MIT
// Stiff test problems, and failures of implicit methods: a singular matrix, a Jacobian that does not exist.
#pragma once

#include <myriad/kernel/model/tangent.hpp>
#include <myriad/model.hpp>

#include "problems/robertson.hpp"
#include "tests/support/problems.hpp"

namespace stiff {

/// With rates 0.04, 3e7, 1e4.
struct robertson : problems::robertson {
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 3> rhs(auto, const myriad::vec<R, 3>& y, const auto&) {
        return slope<R>(y, R(0.04), R(3e7));
    }
};

/// The same with its Jacobian written out.
struct robertson_with_jacobian : robertson {
    template <class R>
    MYRIAD_FUNCTION static myriad::matrix<R, 3> jacobian(auto, const myriad::vec<R, 3>& y, const auto&) {
        const R fast = R(6e7) * y[b], by_b = R(1e4) * y[c], by_c = R(1e4) * y[b];
        return {{{{R(-0.04), by_b, by_c}}, {{R(0.04), -fast - by_b, -by_c}}, {{R(0), fast, R(0)}}}};
    }
};

/// van der Pol's oscillator in the form of Hairer and Wanner, eps y'' = (1 - y^2) y' - y; an accessory stores the
/// largest slope. + - * / only.
struct van_der_pol {
    enum state { x, v, n_state };
    enum parameter { eps, n_parameter };
    enum accessory { fastest, n_accessory };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> rhs(auto, const myriad::vec<R, 2>& y, const auto& p) {
        return {y[v], ((R(1) - y[x] * y[x]) * y[v] - y[x]) / p[eps]};
    }
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        lane.accessory[fastest] = myriad::max(lane.accessory[fastest], myriad::abs(lane.y[v]));
    }
};

/// Prothero and Robinson: y' = -rate (y - sin t) + cos t, whose solution is sin t however stiff it is.
struct prothero_robinson {
    enum state { y0, n_state };
    enum parameter { rate, n_parameter };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto t, const myriad::vec<R, 1>& y, const auto& p) {
        return myriad::vec<R, 1>{p[rate] * (myriad::sin(t) - y[y0]) + myriad::cos(t)};
    }
};

using prothero_robinson_with_tangent = myriad::with_tangents<prothero_robinson>;

using problems::roessler;

/// The relay: y' = -1e4 (y - cos t - raised) - sin t follows cos t + raised; when it has fallen to 1/2, it and its
/// target are raised by one: at pi/3 and 2 pi/3, and not again before t = 4.
struct relay {
    enum state { y0, n_state };
    enum accessory { raised, last_event, largest, n_accessory };
    enum integer_accessory { begun, finished, n_integer_accessory };
    enum event { low, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto t, const myriad::vec<R, 1>& y, const auto& p) {
        return myriad::vec<R, 1>{R(-1e4) * (y[y0] - myriad::cos(t) - p.accessory[raised]) - myriad::sin(t)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> events(auto, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{y[y0] - R(0.5)};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        lane.y[y0] = 1;
        lane.accessory[largest] = 1;
        lane.accessory[raised] = 0;
        lane.integer_accessory[begun] += 1;
    }
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        lane.accessory[largest] = myriad::max(lane.accessory[largest], lane.y[y0]);
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.accessory[last_event] = lane.t;
        lane.accessory[raised] += 1;
        lane.y[y0] += 1;
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) { lane.integer_accessory[finished] += 1; }
};

/// Heat conduction in a rod of n points with cold ends: y_i' = rate (y_(i-1) - 2 y_i + y_(i+1)). `mode` is an
/// eigenvector.
template <int n>
struct rod {
    enum state { first, n_state = n };
    enum parameter { rate, n_parameter };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n> rhs(auto, const myriad::vec<R, n>& y, const auto& p) {
        myriad::vec<R, n> f;
        for (int i = 0; i < n; ++i) {
            const R left = i > 0 ? y[i - 1] : R(0), right = i < n - 1 ? y[i + 1] : R(0);
            f[i] = p[rate] * (left - y[i] - y[i] + right);
        }
        return f;
    }
};

/// x' = rate x, y' = -y: with rate = 1 / (h gamma) the matrix of a step of length h is singular.
struct growth {
    enum state { x, y, n_state };
    enum parameter { rate, n_parameter };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> rhs(auto, const myriad::vec<R, 2>& s, const auto& p) {
        return {p[rate] * s[x], -s[y]};
    }
};

/// A ball dropped onto a floor at zero, put back exactly onto it at every impact and thrown up with part of its speed.
struct ball {
    enum state { x, v, n_state };
    enum parameter { restitution, n_parameter };
    enum event { impact, n_event };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> rhs(auto, const myriad::vec<R, 2>& y, const auto&) {
        return {y[v], R(-10)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> events(auto, const myriad::vec<R, 2>& y, const auto&) {
        return myriad::vec<R, 1>{y[x]};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.y[x] = 0;
        lane.y[v] = -lane.parameter[restitution] * lane.y[v];
    }
};

/// y' = -sqrt(y): at zero rhs is finite and its derivative infinite.
struct draining {
    enum state { y0, n_state };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{-myriad::sqrt(y[y0])};
    }
};

}  // namespace stiff
