// SPDX-License-Identifier: MIT
// The Duffing oscillator with two wells, for models that differ in forcing, parameters and observed quantities.
#pragma once

#include <myriad/model.hpp>

namespace problems {

/// x'' + k x' - x + x^3 = forcing.
struct duffing {
    enum state { x, v, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> slope(const myriad::vec<R, n_state>& y, const R& k,
                                                         const R& forcing) {
        return {y[v], y[x] - y[x] * y[x] * y[x] - k * y[v] + forcing};
    }
};

}  // namespace problems
