// SPDX-License-Identifier: MIT
// Exponential decay x' = -k x, the smallest model, as a user of the installed package writes it.
#pragma once

#include <myriad/model.hpp>

struct decay {
    enum state { x, n_state };
    enum parameter { k, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-p[k] * y[x]};
    }
};
