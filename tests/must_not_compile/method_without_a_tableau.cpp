// expect: a method is a struct with `static constexpr` members
// SPDX-License-Identifier: MIT
// A method is its tableau and what it says of it.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x]};
    }
};

struct nothing {
    static constexpr int stages = 1;
    static constexpr int order = 1;
};

MYRIAD_INSTANTIATE(decay, nothing)
