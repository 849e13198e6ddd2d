// SPDX-License-Identifier: MIT
// Kepler's problem in the plane, without events: what rounding does to long integrations.
#pragma once

#include <myriad/model.hpp>

namespace validation {

/// x'' = -x / r^3, y'' = -y / r^3.
struct orbit {
    enum state { x, y, u, v, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto&) {
        const R square = s[x] * s[x] + s[y] * s[y];
        const R inverse = R(1) / (square * myriad::sqrt(square));
        return {s[u], s[v], -(s[x] * inverse), -(s[y] * inverse)};
    }
};

}  // namespace validation
