// expect: read-only|returns a const value|const-qualified
// SPDX-License-Identifier: MIT
// The time is the integrator's.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };
    enum parameter { k, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-(p[k] * y[x])};
    }
    MYRIAD_FUNCTION static void after_step(auto& lane) { lane.t = 2; }
};

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)
