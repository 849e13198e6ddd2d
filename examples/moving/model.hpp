// SPDX-License-Identifier: MIT
// Van der Pol's oscillator, the model of the pages about moving from other packages.
#pragma once

// snippet: model
#include <myriad/model.hpp>

struct van_der_pol {  // x'' = mu (1 - x^2) x' - x
    enum state { x, v, n_state };
    enum parameter { mu, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], p[mu] * (R(1) - y[x] * y[x]) * y[v] - y[x]};
    }
};
// end of snippet
