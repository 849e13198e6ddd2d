// expect: with_sensitivities takes enumerators of the model's states, parameters and shared values
// SPDX-License-Identifier: MIT
// The parameter is another model's.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"
#include "myriad/sensitivity.hpp"

struct oscillator {
    enum state { x, v, n_state };
    enum parameter { k, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], -p[k] * y[x]};
    }
};
struct other {
    enum parameter { k, n_parameter };
};
using by_other = myriad::with_sensitivities<oscillator, other::k>;

MYRIAD_INSTANTIATE(by_other, myriad::runge_kutta_4)
