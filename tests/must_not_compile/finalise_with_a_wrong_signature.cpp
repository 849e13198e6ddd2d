// expect: finalise has a wrong signature: it must be
// SPDX-License-Identifier: MIT
// finalise sees the lane alone.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };
    enum parameter { k, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-(p[k] * y[x])};
    }
    MYRIAD_FUNCTION static void finalise(double, auto&) {}
};

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)
