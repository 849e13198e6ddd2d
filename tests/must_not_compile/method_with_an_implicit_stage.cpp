// expect: matrix a must be lower triangular
// SPDX-License-Identifier: MIT
// Stages are computed one after the other; a weight of a later one would be left out.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x]};
    }
};

struct implicit {
    static constexpr int stages = 2;
    static constexpr int order = 2;
    static constexpr int embedded_order = 0;
    static constexpr bool first_same_as_last = false;
    static constexpr auto tableau() {
        myriad::explicit_tableau<stages> t{};
        t.c = {0, 1};
        t.a[1] = {1.0 / 2, 1.0 / 2};
        t.b = {1.0 / 2, 1.0 / 2};
        return t;
    }
};

MYRIAD_INSTANTIATE(decay, implicit)
