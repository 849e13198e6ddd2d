// expect: has not the order that interpolant_order claims
// SPDX-License-Identifier: MIT
// The extra stage of an interpolant is computed at a wrong time.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x]};
    }
};

struct late : myriad::dormand_prince_8 {
    static constexpr double extra_node(int i) {
        return myriad::dormand_prince_8::extra_node(i) + (i == 1 ? 0.01 : 0.0);
    }
};

MYRIAD_INSTANTIATE(decay, late)
