// expect: this model file includes Eigen
// SPDX-License-Identifier: MIT
// The alignment of Eigen's objects depends on the flags of model files.
#include <Eigen/Core>

#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x]};
    }
};

MYRIAD_INSTANTIATE(decay, myriad::cash_karp)
