// expect: a vec is given as many values as it has components
// SPDX-License-Identifier: MIT
// The slopes of the others would be zero.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct model {
    enum state { x, v, w, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[v]};
    }
};

MYRIAD_INSTANTIATE(model, myriad::runge_kutta_4)
