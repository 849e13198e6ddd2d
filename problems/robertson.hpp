// SPDX-License-Identifier: MIT
// Robertson's chemical kinetics (in: Numerical Analysis, an Introduction, Academic Press 1966, 178-182), stiff.
#pragma once

#include <myriad/model.hpp>

namespace problems {

/// a -> b at rate k1, 2 b -> b + c at k2, b + c -> a + c at 1e4. The sum of the concentrations is conserved.
struct robertson {
    enum state { a, b, c, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> slope(const myriad::vec<R, n_state>& y, const R& k1, const R& k2) {
        const R slow = k1 * y[a], fast = k2 * y[b] * y[b], back = R(1e4) * y[b] * y[c];
        return {back - slow, slow - back - fast, fast};
    }
};

}  // namespace problems
