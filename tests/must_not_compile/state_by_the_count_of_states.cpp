// expect: there is no component of this number: components are counted from 0
// SPDX-License-Identifier: MIT
// What lies beyond the states is another number.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct model {
    enum state { x, v, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[n_state], -y[x]};
    }
};

MYRIAD_INSTANTIATE(model, myriad::runge_kutta_4)
