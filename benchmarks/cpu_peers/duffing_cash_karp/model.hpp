// SPDX-License-Identifier: MIT
// The Duffing oscillator as a Myriad model, without events and hooks.
#pragma once

#include <myriad/model.hpp>

namespace cpu_peers {

/// x' = v, v' = x (1 - x^2) - k v + B cos t.
struct duffing_model {
    enum state { x, v, n_state };
    enum parameter { k, n_parameter };
    enum shared { B, n_shared };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        using myriad::cos, myriad::fma;
        const R linear = fma(-p[k], y[v], p.shared[B] * cos(t));
        return {y[v], fma(y[x], fma(-y[x], y[x], R(1)), linear)};
    }
};

}  // namespace cpu_peers
