// SPDX-License-Identifier: MIT
// The Lorenz system as a Myriad model.
#pragma once

#include <myriad/model.hpp>

namespace cpu_peers {

/// x' = 10 (y - x), y' = p x - y - x z, z' = x y - 8/3 z.
struct lorenz_model {
    enum state { x, y, z, n_state };
    enum parameter { p, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& u, const auto& q) {
        return {10.0 * (u[y] - u[x]), q[p] * u[x] - u[y] - u[x] * u[z], u[x] * u[y] - 8.0 / 3.0 * u[z]};
    }
};

}  // namespace cpu_peers
