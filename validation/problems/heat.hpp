// SPDX-License-Identifier: MIT
// Heat conduction in a spherical shell by collocation: one differentiation matrix for all instances.
#pragma once

#include <myriad/model.hpp>

namespace validation {

/// T_t = kappa / r^2 (r^2 T_r)_r on 1 < r < 2 with T = 0 at both ends, at the inner Chebyshev points; the matrix D maps
/// values at all points, zero at the first and the last, to slopes at all points.
struct heat {
    static constexpr int inner = 10, points = inner + 2;
    enum state { first, n_state = inner };
    enum parameter { kappa, n_parameter };
    enum shared { matrix, radius = points * points, n_shared = radius + points };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& temperature,
                                                       const auto& p) {
        myriad::vec<R, points> flux;
        for (int i = 0; i < points; ++i) {
            R sum = R(0);
            for (int j = 0; j < inner; ++j) sum += p.shared[matrix + i * points + j + 1] * temperature[j];
            flux[i] = p.shared[radius + i] * p.shared[radius + i] * sum;
        }
        myriad::vec<R, n_state> slope;
        for (int i = 0; i < inner; ++i) {
            R sum = R(0);
            for (int j = 0; j < points; ++j) sum += p.shared[matrix + (i + 1) * points + j] * flux[j];
            slope[i] = p[kappa] * sum / (p.shared[radius + i + 1] * p.shared[radius + i + 1]);
        }
        return slope;
    }
};

}  // namespace validation
