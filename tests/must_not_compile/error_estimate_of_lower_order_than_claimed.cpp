// expect: has not the order that embedded_order claims
// SPDX-License-Identifier: MIT
// Steps would be chosen by a wrong power of the error.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x]};
    }
};

struct boastful : myriad::cash_karp {
    static constexpr int embedded_order = 5;
};

MYRIAD_INSTANTIATE(decay, boastful)
