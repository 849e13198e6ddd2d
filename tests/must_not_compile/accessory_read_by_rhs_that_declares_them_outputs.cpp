// expect: no member named.*accessory
// SPDX-License-Identifier: MIT
// A model that says that rhs does not see accessories does not see them.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    static constexpr bool accessories_are_outputs = true;
    enum state { x, n_state };
    enum accessory { k, n_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-(p.accessory[k] * y[x])};
    }
};

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)
