// expect: this model calls std::sin, which knows neither packs of instances nor derivatives
// SPDX-License-Identifier: MIT
// Functions that take plain numbers have no derivative, which tangents need.
#include <cmath>

#include "myriad/instantiate.hpp"
#include "myriad/kernel/model/tangent.hpp"
#include "myriad/model.hpp"

struct pendulum {
    static constexpr bool scalar_only = true;
    enum state { x, v, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[v], -std::sin(y[x])};
    }
};

MYRIAD_INSTANTIATE(myriad::with_tangents<pendulum>, myriad::runge_kutta_4)
