// expect: rhs has a wrong signature: it must be
// SPDX-License-Identifier: MIT
// The right-hand side is generic over the scalar.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };
    enum parameter { k, n_parameter };

    MYRIAD_FUNCTION static myriad::vec<double, 1> rhs(double, const myriad::vec<double, 1>& y, const auto& p) {
        return myriad::vec<double, 1>{-(p[k] * y[x])};
    }
};

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)
