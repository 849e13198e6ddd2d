// SPDX-License-Identifier: MIT
// A problem in closed form on which no coefficient of a method is without effect.
#pragma once

#include <myriad/model.hpp>

namespace validation {

/// The circle in logarithmic coordinates, run through at the speed 1 + t: nonlinear, coupled, and time counts, so that
/// every node, weight and order condition does. Solution: exp(sin s), exp(cos s) with s = s(0) + t + t^2 / 2.
struct timed_circle {
    enum state { u, w, n_state };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> rhs(auto t, const myriad::vec<R, 2>& y, const auto&) {
        const R speed = R(1) + t;
        return {speed * y[u] * myriad::log(y[w]), -(speed * y[w] * myriad::log(y[u]))};
    }
};

}  // namespace validation
