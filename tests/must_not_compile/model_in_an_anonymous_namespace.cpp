// expect: the model is in an anonymous namespace.*move it out
// SPDX-License-Identifier: MIT
// Each file would have a model of its own with that name.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

namespace {

struct model {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{-y[0]};
    }
};
}  // namespace

MYRIAD_INSTANTIATE(model, myriad::runge_kutta_4)
