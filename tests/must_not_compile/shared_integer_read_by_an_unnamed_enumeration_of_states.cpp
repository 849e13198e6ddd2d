// expect: this enumerator is not a shared_integer of the model
// SPDX-License-Identifier: MIT
// Its number fits, so the wrong value would be read.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct model {
    enum { x, n_state };
    enum shared_integer { f, n_shared_integer };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-(R(myriad::real_of<R>(p.shared_integer[x])) * y[x])};
    }
};

MYRIAD_INSTANTIATE(model, myriad::runge_kutta_4)
