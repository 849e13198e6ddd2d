// expect: a model of n components has from 1 to n independent tangent vectors
// SPDX-License-Identifier: MIT
// A third vector in a plane is not independent.
#include "myriad/instantiate.hpp"
#include "myriad/kernel/model/tangent.hpp"
#include "myriad/model.hpp"

struct oscillator {
    enum state { x, v, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[v], -y[x]};
    }
};
using spectrum = myriad::with_tangents<oscillator, 3>;

MYRIAD_INSTANTIATE(spectrum, myriad::runge_kutta_4)
