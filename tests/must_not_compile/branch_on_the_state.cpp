// expect: this model branches on its state: use myriad::select.*scalar_only
// SPDX-License-Identifier: MIT
// A pack of instances has no single truth value.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };
    enum parameter { k, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        if (y[x] > R(0)) return myriad::vec<R, n_state>{-(p[k] * y[x])};
        return myriad::vec<R, n_state>{R(0)};
    }
};

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)
