// SPDX-License-Identifier: MIT
// High irradiance responses of plants, eight reactions of phytochrome (Schaefer, J. Math. Biology 2, 1975, 41), problem
// HIRES of the Test Set for IVP Solvers.
#pragma once

#include <myriad/model.hpp>

namespace problems {

struct hires {
    enum state { first, n_state = 8 };
    static constexpr double t_end = 321.8122;
    static constexpr double start[n_state] = {1, 0, 0, 0, 0, 0, 0, 0.0057};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        using real = myriad::real_of<R>;
        const R bound = real(280.0) * y[5] * y[7];
        return {-real(1.71) * y[0] + real(0.43) * y[1] + real(8.32) * y[2] + real(0.0007),
                real(1.71) * y[0] - real(8.75) * y[1],
                -real(10.03) * y[2] + real(0.43) * y[3] + real(0.035) * y[4],
                real(8.32) * y[1] + real(1.71) * y[2] - real(1.12) * y[3],
                -real(1.745) * y[4] + real(0.43) * y[5] + real(0.43) * y[6],
                -bound + real(0.69) * y[3] + real(1.71) * y[4] - real(0.43) * y[5] + real(0.69) * y[6],
                bound - real(1.81) * y[6],
                real(1.81) * y[6] - bound};
    }
};

}  // namespace problems
