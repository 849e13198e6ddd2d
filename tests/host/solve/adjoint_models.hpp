// SPDX-License-Identifier: MIT
// Models whose adjoints are compared with closed solutions, forward sensitivities and each other.
#pragma once

#include <myriad/model.hpp>
#include <myriad/sensitivity.hpp>

namespace adjoints {

/// x' = -k x + b, y' = k x cos(t): closed solutions.
struct decay {
    enum state { x, y, n_state };
    enum parameter { k, n_parameter };
    enum shared { b, n_shared };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& s, const auto& p) {
        return {p.shared[b] - p[k] * s[x], p[k] * s[x] * myriad::cos(t)};
    }
};

/// A network with many functions and more parameters than states.
struct network {
    enum state { u, v, w, n_state };
    enum parameter { p0, p1, p2, p3, p4, p5, p6, p7, p8, n_parameter };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        using namespace myriad;
        const R drive = sin(p[p0] * t) + p[p1] * exp(-y[u] * y[u]);
        const R gate = p[p2] / (1.0 + exp(-p[p3] * y[v]));
        const R hill = pow(abs(y[w]) + 0.1, p[p4]) / (1.0 + pow(abs(y[w]) + 0.1, p[p4]));
        return {drive - gate * y[u], select(y[u] > p[p5], hill * tanh(y[u]), -p[p6] * y[v]),
                sqrt(1.0 + y[u] * y[u]) - p[p7] * y[w] + fma(p[p8], y[v], hypot(y[u], y[v] + 1.0))};
    }
};
using network_by_all = myriad::uncontrolled_sensitivities<network, network::u, network::v, network::w, network::p0,
                                                          network::p1, network::p2, network::p3, network::p4,
                                                          network::p5, network::p6, network::p7, network::p8>;

/// Robertson's kinetics, stiff, with rates as parameters.
struct kinetics {
    enum state { a, b, c, n_state };
    enum parameter { slow, fast, middle, n_parameter };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        const R made = p[slow] * y[a], gone = p[fast] * y[b] * y[b], back = p[middle] * y[b] * y[c];
        return {back - made, made - back - gone, gone};
    }
};
using kinetics_by_all = myriad::uncontrolled_sensitivities<kinetics, kinetics::a, kinetics::b, kinetics::c,
                                                           kinetics::slow, kinetics::fast, kinetics::middle>;

/// Where x is negative the square root's slope is infinite, but nothing depends on it.
struct guarded {
    enum state { x, n_state };
    enum parameter { k, n_parameter };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {-p[k] * y[x] - myriad::sqrt(myriad::max(y[x], R(0.0)))};
    }
};

}  // namespace adjoints
