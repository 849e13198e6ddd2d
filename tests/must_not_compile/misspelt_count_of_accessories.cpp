// expect: an enumeration .accessory. without its count: make n_accessory its last enumerator
// SPDX-License-Identifier: MIT
// A misspelt count would be none.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct model {
    enum state { x, n_state };
    enum accessory { c, n_accessories };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{-y[0]};
    }
};

MYRIAD_INSTANTIATE(model, myriad::runge_kutta_4)
