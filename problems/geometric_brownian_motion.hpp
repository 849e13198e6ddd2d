// SPDX-License-Identifier: MIT
// Geometric Brownian motion, dx = mu x dt + sigma x dW: three beside each other, each with a Wiener process of its own.
#pragma once

#include <myriad/model.hpp>

namespace problems {

struct geometric_brownian_motion {
    enum state { x, y, z, n_state };
    enum shared { mu, sigma, n_shared };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {p.shared[mu] * s[x], p.shared[mu] * s[y], p.shared[mu] * s[z]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> diffusion(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {p.shared[sigma] * s[x], p.shared[sigma] * s[y], p.shared[sigma] * s[z]};
    }
};

}  // namespace problems
