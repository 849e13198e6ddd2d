// expect: this enumerator is not a shared of the model
// SPDX-License-Identifier: MIT
// Its number fits, so the wrong value would be read.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct model {
    enum state { x, n_state };
    enum parameter { k, n_parameter };
    enum shared { f, n_shared };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-(p.shared[k] * y[x])};
    }
};

MYRIAD_INSTANTIATE(model, myriad::runge_kutta_4)
