// expect: this model branches on its state: use myriad::select.*scalar_only
// SPDX-License-Identifier: MIT
// The same for the operator ?:.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };
    enum parameter { k, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{y[x] > R(0) ? -(p[k] * y[x]) : R(0)};
    }
};

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)
