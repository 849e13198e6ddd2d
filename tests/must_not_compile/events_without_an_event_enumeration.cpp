// expect: a model with events has both `enum event
// SPDX-License-Identifier: MIT
// The function needs an enumeration of events.
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
    MYRIAD_FUNCTION static myriad::vec<R, 1> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, 1>{y[x]};
    }
};

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)
