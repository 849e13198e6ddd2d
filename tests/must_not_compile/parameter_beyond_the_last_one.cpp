// expect: there is no component of this number: components are counted from 0
// SPDX-License-Identifier: MIT
// What lies beyond the parameters is another number.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct model {
    enum state { x, n_state };
    enum parameter { k, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-(p[1] * y[x])};
    }
};

MYRIAD_INSTANTIATE(model, myriad::runge_kutta_4)
