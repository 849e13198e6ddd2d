// expect: a vec is given as many values as it has components
// SPDX-License-Identifier: MIT
// The function of the second event would be zero.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct model {
    enum state { x, v, n_state };
    enum event { first, second, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[v], -y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[x]};
    }
};

MYRIAD_INSTANTIATE(model, myriad::runge_kutta_4)
