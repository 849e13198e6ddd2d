// expect: the tableau has not as many stages as the method says
// SPDX-License-Identifier: MIT
// The last stage would never be computed.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x]};
    }
};

struct hasty : myriad::cash_karp {
    static constexpr int stages = 5;
};

MYRIAD_INSTANTIATE(decay, hasty)
