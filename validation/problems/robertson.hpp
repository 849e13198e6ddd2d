// SPDX-License-Identifier: MIT
// Robertson's chemical reaction, stiff.
#pragma once

#include <myriad/model.hpp>

namespace validation {

/// a -> b at rate k1, 2 b -> b + c at k2, b + c -> a + c at k3 (1e4). The sum a + b + c is constant.
struct robertson {
    enum state { a, b, c, n_state };
    enum parameter { k1, k2, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        const R one = p[k1] * y[a], two = p[k2] * y[b] * y[b], three = R(1e4) * y[b] * y[c];
        return {three - one, one - three - two, two};
    }
};

}  // namespace validation
