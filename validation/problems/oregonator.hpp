// SPDX-License-Identifier: MIT
// The Oregonator, a model of the Belousov-Zhabotinsky reaction, stiff.
#pragma once

#include <myriad/model.hpp>

namespace validation {

/// Field and Noyes, J. Chem. Phys. 60 (1974) 1877-1884, in the form of Hairer and Wanner, Solving ODE II, IV.10,
/// (10.15).
struct oregonator {
    enum state { a, b, c, n_state };
    enum parameter { s, n_parameter };  // 77.27 in the source

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {p[s] * (y[b] + y[a] * (R(1) - R(8.375e-6) * y[a] - y[b])), (y[c] - (R(1) + y[a]) * y[b]) / p[s],
                R(0.161) * (y[a] - y[c])};
    }
};

}  // namespace validation
