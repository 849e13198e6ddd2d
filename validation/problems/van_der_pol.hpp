// SPDX-License-Identifier: MIT
// The van der Pol oscillator.
#pragma once

#include <myriad/model.hpp>

namespace validation {

/// x'' - mu (1 - x^2) x' + x = 0.
struct van_der_pol {
    enum state { x, v, n_state };
    enum parameter { mu, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], p[mu] * (R(1) - y[x] * y[x]) * y[v] - y[x]};
    }
};

}  // namespace validation
