// expect: with_sensitivities takes no model with a mass_matrix, which would have to multiply them too
// SPDX-License-Identifier: MIT
// The derivatives would follow from equations without the matrix.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"
#include "myriad/sensitivity.hpp"

struct heavy {
    enum state { x, v, n_state };
    enum parameter { k, n_parameter };
    static constexpr myriad::mass_entry mass_matrix[] = {{x, x, 1}, {v, v, 2}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], -p[k] * y[x]};
    }
};
using by_k = myriad::with_sensitivities<heavy, heavy::k>;

MYRIAD_INSTANTIATE(by_k, myriad::runge_kutta_4)
