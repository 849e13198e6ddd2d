// expect: the method is in an anonymous namespace.*move it out
// SPDX-License-Identifier: MIT
// Every file has a method of that name of its own.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct model {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{-y[0]};
    }
};

namespace {
struct my_own : myriad::runge_kutta_4 {};
}  // namespace

MYRIAD_INSTANTIATE(model, my_own)
