// SPDX-License-Identifier: MIT
// Van der Pol oscillators in a ring, each pulled by its neighbours: stiff, with a sparse Jacobian.
#pragma once

#include <myriad/model.hpp>

namespace problems {

/// n / 2 oscillators x'' = mu (1 - x^2) x' - x + pull (left - 2 x + right).
template <int n>
struct van_der_pol_ring {
    static_assert(n % 2 == 0);
    enum state { first, n_state = n };  // place and velocity of each
    enum parameter { mu, n_parameter };
    static constexpr double pull = 10;

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n> rhs(auto, const myriad::vec<R, n>& y, const auto& p) {
        myriad::vec<R, n> f;
        MYRIAD_UNROLL
        for (int x = 0; x < n; x += 2) {
            f[x] = y[x + 1];
            f[x + 1] = p[mu] * (R(1) - y[x] * y[x]) * y[x + 1] - y[x] +
                       R(pull) * (y[(x + n - 2) % n] - R(2) * y[x] + y[(x + 2) % n]);
        }
        return f;
    }
};

}  // namespace problems
