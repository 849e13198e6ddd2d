// expect: events has a wrong signature: it must be
// SPDX-License-Identifier: MIT
// There is one value per event.
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
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, 2>{y[x], y[x]};
    }
};

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)
