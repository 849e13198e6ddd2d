// expect: its error weights e are all zero
// SPDX-License-Identifier: MIT
// A method that is to choose its steps needs an estimate.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x]};
    }
};

struct blind : myriad::runge_kutta_4 {
    static constexpr int embedded_order = 3;
};

MYRIAD_INSTANTIATE(decay, blind)
