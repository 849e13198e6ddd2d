// expect: Myriad is compiled with -ffast-math
// flags: -ffast-math
// SPDX-License-Identifier: MIT
// Steps that end in NaN would count as good.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x]};
    }
};

MYRIAD_INSTANTIATE(decay, myriad::cash_karp)
