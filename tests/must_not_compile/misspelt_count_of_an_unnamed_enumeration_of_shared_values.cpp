// expect: the model has no shared: end its enumeration with the enumerator n_shared
// SPDX-License-Identifier: MIT
// Without the name of the enumeration, the index shows it.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct model {
    enum { x, n_state };
    enum { k, n_share };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-(p.shared[k] * y[x])};
    }
};

MYRIAD_INSTANTIATE(model, myriad::runge_kutta_4)
