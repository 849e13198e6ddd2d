// SPDX-License-Identifier: MIT
// Test problems with exact solutions, for the tests of steppers, of the controller and of the loop, and models with
// reference values. Each is a model; `exact(t)` is its solution through `exact(t_begin)`.
#pragma once

#include <myriad/model.hpp>

#include "problems/duffing.hpp"
#include "problems/lorenz.hpp"

namespace problems {

/// DETEST A1: y' = -y. Linear, contracting.
struct decay {
    enum state { y0, n_state };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{-y[y0]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> exact(const R& t) {
        return myriad::vec<R, 1>{myriad::exp(-t)};
    }
};

/// DETEST A2: y' = -y^3 / 2. Nonlinear, contracting.
struct power_decay {
    enum state { y0, n_state };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{-(y[y0] * y[y0] * y[y0]) / R(2)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> exact(const R& t) {
        return myriad::vec<R, 1>{R(1) / myriad::sqrt(R(1) + t)};
    }
};

/// DETEST A3: y' = y cos t.
struct modulated_growth {
    enum state { y0, n_state };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto t, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{y[y0] * myriad::cos(t)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> exact(const R& t) {
        return myriad::vec<R, 1>{myriad::exp(myriad::sin(t))};
    }
};

/// DETEST A4: y' = y/4 (1 - y/20), y(0) = 1.
struct logistic {
    enum state { y0, n_state };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{y[y0] / R(4) * (R(1) - y[y0] / R(20))};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> exact(const R& t) {
        return myriad::vec<R, 1>{R(20) / (R(1) + R(19) * myriad::exp(-t / R(4)))};
    }
};

/// The circle in logarithmic coordinates: autonomous, nonlinear, coupled, and with no zero elementary differential of
/// low order, so that every order condition matters.
struct log_circle {
    enum state { u, w, n_state };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> rhs(auto, const myriad::vec<R, 2>& y, const auto&) {
        return {y[u] * myriad::log(y[w]), -(y[w] * myriad::log(y[u]))};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> exact(const R& t) {
        return {myriad::exp(myriad::sin(t)), myriad::exp(myriad::cos(t))};
    }
};

/// The same, traversed at a speed that grows with time: the nodes c matter too.
struct timed_circle {
    enum state { u, w, n_state };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> rhs(auto t, const myriad::vec<R, 2>& y, const auto&) {
        const R speed = t + t;
        return {speed * y[u] * myriad::log(y[w]), -(speed * y[w] * myriad::log(y[u]))};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> exact(const R& t) {
        return {myriad::exp(myriad::sin(t * t)), myriad::exp(myriad::cos(t * t))};
    }
};

/// y' = degree t^(degree - 1): a quadrature. A method of order p integrates it exactly for degree <= p.
template <int degree>
struct monomial {
    enum state { y0, n_state };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto t, const myriad::vec<R, 1>&, const auto&) {
        return myriad::vec<R, 1>{R(degree) * myriad::pow(t, degree - 1)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> exact(const R& t) {
        return myriad::vec<R, 1>{myriad::pow(t, degree)};
    }
};

/// x'' = -x, without a product, so that all compilers round it in the same way.
struct oscillator {
    enum state { x, v, n_state };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> rhs(auto, const myriad::vec<R, 2>& y, const auto&) {
        return {y[v], -y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> exact(const R& t) {
        return {myriad::cos(t), -myriad::sin(t)};
    }
};

/// y' = 1: the error estimate is zero except for rounding.
struct uniform {
    enum state { y0, n_state };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>&, const auto&) {
        return myriad::vec<R, 1>{R(1)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> exact(const R& t) {
        return myriad::vec<R, 1>{t};
    }
};

/// Two uncoupled oscillators with angular frequencies 20 and 1.
struct two_speeds {
    enum state { fast, fast_v, slow, slow_v, n_state };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 4> rhs(auto, const myriad::vec<R, 4>& y, const auto&) {
        return {R(20) * y[fast_v], R(-20) * y[fast], y[slow_v], -y[slow]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 4> exact(const R& t) {
        const R s = R(20) * t;
        return {myriad::cos(s), -myriad::sin(s), myriad::cos(t), -myriad::sin(t)};
    }
};

// Models with reference values and no closed form -------------------------------------------------------------------

/// x'' + 0.3 x' - x + x^3 = 0.5 cos 1.2 t.
struct forced_duffing : duffing {
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> rhs(auto t, const myriad::vec<R, 2>& y, const auto&) {
        return slope<R>(y, R(0.3), R(0.5) * myriad::cos(R(1.2) * t));
    }
};

/// x'' - (1 - x^2) x' + x = 0.
struct van_der_pol {
    enum state { x, v, n_state };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> rhs(auto, const myriad::vec<R, 2>& y, const auto&) {
        return {y[v], (R(1) - y[x] * y[x]) * y[v] - y[x]};
    }
};

/// Roessler's equations (0.2, 0.2, 5.7): chaotic and not stiff, though z often decays at a rate of up to 15.
struct roessler {
    enum state { x, y, z, n_state };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 3> rhs(auto, const myriad::vec<R, 3>& s, const auto&) {
        return {-s[y] - s[z], s[x] + R(0.2) * s[y], R(0.2) + s[z] * (s[x] - R(5.7))};
    }
};

/// angle'' = -9.8 sin(angle). The event is a turning point.
struct pendulum {
    enum state { angle, speed, n_state };
    enum event { turning_point, n_event };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> rhs(auto, const myriad::vec<R, 2>& y, const auto&) {
        return {y[speed], R(-9.8) * myriad::sin(y[angle])};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> events(auto, const myriad::vec<R, 2>& y, const auto&) {
        return myriad::vec<R, 1>{y[speed]};
    }
};

}  // namespace problems
