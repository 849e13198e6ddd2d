// expect: the model has no components of this kind: end their enumeration with the enumerator that counts them
// SPDX-License-Identifier: MIT
// Without the name of the enumeration, the index shows it.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct model {
    enum { x, n_state };
    enum { c, n_accessories };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-(y[x] * y[x])};
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) { lane.accessory[c] = lane.y[x]; }
};

MYRIAD_INSTANTIATE(model, myriad::runge_kutta_4)
