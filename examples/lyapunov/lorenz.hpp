// SPDX-License-Identifier: MIT
// Lorenz' equations, and the same with all three tangent vectors.
#pragma once

#include <myriad/model.hpp>
#include <myriad/tangent.hpp>

// snippet: model
struct lorenz {
    enum state { x, y, z, n_state };
    enum parameter { rho, n_parameter };
    enum shared { sigma, beta, n_shared };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {p.shared[sigma] * (s[y] - s[x]), s[x] * (p[rho] - s[z]) - s[y], s[x] * s[y] - p.shared[beta] * s[z]};
    }
};
using lorenz_spectrum = myriad::with_tangents<lorenz, 3>;
// end of snippet
