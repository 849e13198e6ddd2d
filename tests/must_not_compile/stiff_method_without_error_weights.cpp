// expect: tableau has no error weights e
// SPDX-License-Identifier: MIT
// It would accept every step.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct model {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{-y[0]};
    }
};

struct careless : myriad::rosenbrock_23 {
    static constexpr auto tableau() {
        auto t = myriad::rosenbrock_23::tableau();
        t.e = {};
        return t;
    }
};

MYRIAD_INSTANTIATE(model, careless)
