// expect: the model has no state: give it `enum state
// SPDX-License-Identifier: MIT
// A model needs a state.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum parameter { k, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto& p) {
        return myriad::vec<R, 1>{-(p[k] * y[0])};
    }
};

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)
