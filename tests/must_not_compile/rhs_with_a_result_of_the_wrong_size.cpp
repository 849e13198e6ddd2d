// expect: rhs has a wrong signature: it must be
// SPDX-License-Identifier: MIT
// The right-hand side returns one slope per state.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };
    enum parameter { k, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, 2>{-(p[k] * y[x]), y[x]};
    }
};

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)
