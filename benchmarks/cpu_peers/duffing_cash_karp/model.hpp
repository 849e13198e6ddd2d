// SPDX-License-Identifier: MIT
// The Duffing oscillator as a Myriad model, without events and hooks.
#pragma once

#include <myriad/model.hpp>

namespace cpu_peers {

/// x' = v, v' = x - x^3 - k v + B cos t.
struct duffing_model {
    enum state { x, v, n_state };
    enum parameter { k, n_parameter };
    enum shared { B, n_shared };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        using myriad::cos;
        return {y[v], y[x] - y[x] * y[x] * y[x] - p[k] * y[v] + p.shared[B] * cos(t)};
    }
};

}  // namespace cpu_peers
