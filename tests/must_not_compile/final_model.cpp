// expect: the model is declared final: its hooks cannot be found by name; remove
// SPDX-License-Identifier: MIT
// Hooks of a final model cannot be found by name.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay final {
    enum state { x, n_state };
    enum parameter { k, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-(p[k] * y[x])};
    }
};

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)
