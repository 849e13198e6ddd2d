// expect: after_step has a wrong signature: it must be
// SPDX-License-Identifier: MIT
// A generic after_step returns a mask: an action is for one instance.
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
    MYRIAD_FUNCTION static myriad::action after_step(auto&) {
        return myriad::action::proceed;
    }
};

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)
