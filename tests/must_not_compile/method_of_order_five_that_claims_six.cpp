// expect: do not satisfy the conditions of the order that it claims
// SPDX-License-Identifier: MIT
// Orders above five are looked at, too.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x]};
    }
};

struct boastful : myriad::tsitouras_5 {
    static constexpr int order = 6;
};

MYRIAD_INSTANTIATE(decay, boastful)
