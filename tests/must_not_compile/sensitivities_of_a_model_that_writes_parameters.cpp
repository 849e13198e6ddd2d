// expect: with_sensitivities takes no model that writes parameters: let its hooks write an accessory instead
// SPDX-License-Identifier: MIT
// The derivative of a parameter that a hook has computed would be lost.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"
#include "myriad/sensitivity.hpp"

struct adaptive {
    enum state { x, n_state };
    enum parameter { k, n_parameter };
    static constexpr bool writes_parameters = true;

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-p[k] * y[x]};
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) { lane.parameter[k] = lane.y[x]; }
};
using by_k = myriad::with_sensitivities<adaptive, adaptive::k>;

MYRIAD_INSTANTIATE(by_k, myriad::runge_kutta_4)
