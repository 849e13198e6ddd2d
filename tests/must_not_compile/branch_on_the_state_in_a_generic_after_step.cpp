// expect: this model branches on its state: use myriad::select.*scalar_only
// SPDX-License-Identifier: MIT
// A generic hook sees the whole pack.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };
    enum parameter { k, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-(p[k] * y[x])};
    }
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        if (lane.y[x] > R(1)) lane.y[x] = R(1);
    }
};

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)
