// SPDX-License-Identifier: MIT
// The squid's giant axon (Hodgkin and Huxley, J. Physiol. 117 (1952) 500-544), in mV and ms, with the potential shifted
// to rest at -65 mV: four states, six exponentials.
#pragma once

#include <myriad/model.hpp>

namespace problems {

struct hodgkin_huxley {
    enum state { v, m, h, n, n_state };
    enum parameter { current, n_parameter };  // in microamperes per square centimetre

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        using myriad::exp;
        const R hair = number<R>(1e-7);  // so that no rate is 0 / 0
        const R x = (y[v] + R(40)) / R(10) + hair, z = (y[v] + R(55)) / R(10) + hair;
        const R opens_m = x / (R(1) - exp(-x)), closes_m = R(4) * exp(-(y[v] + R(65)) / R(18));
        const R opens_h = number<R>(0.07) * exp(-(y[v] + R(65)) / R(20));
        const R closes_h = R(1) / (R(1) + exp(-(y[v] + R(35)) / R(10)));
        const R opens_n = number<R>(0.1) * z / (R(1) - exp(-z)),
                closes_n = number<R>(0.125) * exp(-(y[v] + R(65)) / R(80));
        const R sodium = R(120) * y[m] * y[m] * y[m] * y[h] * (y[v] - R(50));
        const R potassium = R(36) * y[n] * y[n] * y[n] * y[n] * (y[v] + R(77));
        return {p[current] - sodium - potassium - number<R>(0.3) * (y[v] + number<R>(54.387)),
                opens_m * (R(1) - y[m]) - closes_m * y[m], opens_h * (R(1) - y[h]) - closes_h * y[h],
                opens_n * (R(1) - y[n]) - closes_n * y[n]};
    }

private:
    template <class R>
    MYRIAD_FUNCTION static R number(double value) {
        return R(static_cast<myriad::real_of<R>>(value));
    }
};

}  // namespace problems
