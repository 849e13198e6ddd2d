// expect: a model with events has both `enum event
// SPDX-License-Identifier: MIT
// An enumeration of events needs the function.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };
    enum parameter { k, n_parameter };
    enum event { zero, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-(p[k] * y[x])};
    }
};

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)
