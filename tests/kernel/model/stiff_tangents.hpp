// SPDX-License-Identifier: MIT
// Stiff models with tangents: networks, whose factors are sparse, and with a rhs that depends on time in every way.
#pragma once

#include <myriad/kernel/model/tangent.hpp>
#include <myriad/model.hpp>

#include "problems/van_der_pol_ring.hpp"
#include "tests/kernel/model/tangent_models.hpp"
#include "tests/support/stiff.hpp"

namespace stiff_tangents {

using ring = problems::van_der_pol_ring<8>;
using ring_with_two = myriad::with_tangents<ring, 2>;

/// A forced pair whose second derivatives differ from zero, also those by the state and t.
struct forced {
    enum state { x, v, n_state };
    enum parameter { k, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return {p[k] * (y[v] - y[x] * y[x] * y[x]) + y[x] * myriad::sin(3.0 * t), t * t - y[v] / (R(1) + y[x] * y[x])};
    }
};
using forced_with_one = myriad::with_tangents<forced>;

}  // namespace stiff_tangents
