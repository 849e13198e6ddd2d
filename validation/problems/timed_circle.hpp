// SPDX-License-Identifier: MIT
// A problem in closed form to which every coefficient of a method matters.
#pragma once

#include <myriad/model.hpp>

namespace validation {

/// The circle in logarithmic coordinates, traversed at the speed 1 + t: nonlinear, coupled and time-dependent, so that
/// every node, weight and order condition matters. Solution: exp(sin s), exp(cos s) with s = s(0) + t + t^2 / 2.
struct timed_circle {
    enum state { u, w, n_state };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> rhs(auto t, const myriad::vec<R, 2>& y, const auto&) {
        const R speed = R(1) + t;
        return {speed * y[u] * myriad::log(y[w]), -(speed * y[w] * myriad::log(y[u]))};
    }
};

}  // namespace validation
