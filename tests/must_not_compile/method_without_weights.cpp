// expect: tableau has no weights b
// SPDX-License-Identifier: MIT
// The solution would stay where it is.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct model {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{-y[0]};
    }
};

struct heun_euler {
    static constexpr int stages = 2, order = 2, embedded_order = 1;
    static constexpr bool first_same_as_last = false;
    static constexpr myriad::explicit_tableau<stages> tableau() {
        myriad::explicit_tableau<stages> t{};
        t.c = {0, 1};
        t.a[1] = {1};
        t.e = {-0.5, 0.5};
        return t;
    }
};

MYRIAD_INSTANTIATE(model, heun_euler)
