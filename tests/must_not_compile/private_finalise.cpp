// expect: finalise has a wrong signature: .* and public
// expect: private (within this context|member of)
// SPDX-License-Identifier: MIT
// The library must be able to call it.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct model {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{-y[0]};
    }

private:
    MYRIAD_FUNCTION static void finalise(auto&) {}
};

MYRIAD_INSTANTIATE(model, myriad::runge_kutta_4)
