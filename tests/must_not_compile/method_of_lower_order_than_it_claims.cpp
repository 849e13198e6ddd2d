// expect: do not satisfy the conditions of the order that it claims
// SPDX-License-Identifier: MIT
// A digit of a coefficient is wrong, and the author of the method has not asked for its order conditions.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x]};
    }
};

struct misprinted : myriad::cash_karp {
    static constexpr auto tableau() {
        auto t = myriad::cash_karp::tableau();
        t.a[2] = {3.0 / 40, 9.0 / 41};
        return t;
    }
};

MYRIAD_INSTANTIATE(decay, misprinted)
