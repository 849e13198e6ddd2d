// SPDX-License-Identifier: MIT
// The model of the README: the minimum that a model needs.
#pragma once

// snippet: model
#include <myriad/model.hpp>

struct duffing {  // x'' + k x' - x + x^3 = B cos t
    enum state { x, v, n_state };
    enum parameter { k, n_parameter };  // every instance has its own
    enum shared { B, n_shared };        // the same for all

    template <class R>  // R is a number, or a pack of numbers in SIMD lanes
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], y[x] - y[x] * y[x] * y[x] - p[k] * y[v] + p.shared[B] * myriad::cos(t)};
    }
};
// end of snippet
