// SPDX-License-Identifier: MIT
// The model of which dense output is timed: the Duffing oscillator.
#pragma once

#include <myriad/model.hpp>

struct forced_oscillator {
    enum state { x, v, n_state };
    enum parameter { k, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], y[x] - y[x] * y[x] * y[x] - p[k] * y[v] + R(0.3) * myriad::cos(t)};
    }
};
