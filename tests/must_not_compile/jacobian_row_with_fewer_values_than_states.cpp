// expect: a vec is given as many values as it has components
// SPDX-License-Identifier: MIT
// The derivative by the second state would be zero.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct model {
    enum state { x, v, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[v], -y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::matrix<R, n_state> jacobian(auto, const myriad::vec<R, n_state>&, const auto&) {
        return {{R(0), R(1)}, {R(-1)}};
    }
};

MYRIAD_INSTANTIATE(model, myriad::rodas_5p)
