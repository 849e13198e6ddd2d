// expect: an enumeration .state. without its count: make n_state its last enumerator
// SPDX-License-Identifier: MIT
// A misspelt count would be none.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct model {
    enum state { c, n_states };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{-y[0]};
    }
};

MYRIAD_INSTANTIATE(model, myriad::runge_kutta_4)
