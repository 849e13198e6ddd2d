// expect: there is no component of this number: components are counted from 0
// SPDX-License-Identifier: MIT
// What lies beyond the accessories is another number.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct model {
    enum state { x, n_state };
    enum accessory { c, n_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-(y[x] * y[x])};
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) { lane.accessory[3] = lane.y[x]; }
};

MYRIAD_INSTANTIATE(model, myriad::runge_kutta_4)
