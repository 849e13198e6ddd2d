// SPDX-License-Identifier: MIT
// The Lorenz system as a Myriad model.
#pragma once

#include <myriad/model.hpp>

namespace cpu_peers {

/// x' = 10 (y - x), y' = p x - y - x z, z' = x y - 8/3 z; in six instructions, since the compiler fuses nothing in a model.
struct lorenz_model {
    enum state { x, y, z, n_state };
    enum parameter { p, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& u, const auto& q) {
        using myriad::fma;
        return {R(10) * (u[y] - u[x]), fma(u[x], q[p] - u[z], -u[y]), fma(u[x], u[y], -(R(8.0 / 3) * u[z]))};
    }
};

}  // namespace cpu_peers
