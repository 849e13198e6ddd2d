// expect: claims first_same_as_last, but its last stage is not the slope at the new state
// SPDX-License-Identifier: MIT
// The last stage of rodas_5p is not at the new state either.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x]};
    }
};

struct reckless : myriad::rodas_5p {
    static constexpr bool first_same_as_last = true;
};

MYRIAD_INSTANTIATE(decay, reckless)
