// SPDX-License-Identifier: MIT
// The ring modulator, 15 voltages and currents that two signals drive (Horneber, dissertation, Kaiserslautern 1976),
// problem RINGMOD of the Test Set for IVP Solvers: stiff, oscillating, and dependent on time.
#pragma once

#include <myriad/model.hpp>

namespace problems {

struct ring_modulator {
    enum state { first, n_state = 15 };       // seven voltages, eight currents
    enum parameter { carrier, n_parameter };  // amplitude of the fast signal; 2 in the test set
    static constexpr double t_end = 1e-3;

    template <class R>
    MYRIAD_FUNCTION static R diode(const R& voltage) {
        using real = myriad::real_of<R>;
        return real(40.67286402e-9) * (myriad::exp(real(17.7493332) * voltage) - real(1));
    }

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        using real = myriad::real_of<R>;
        constexpr real per_c(1 / 1.6e-8), per_cs(1 / 2e-12), per_cp(1 / 1e-8), per_lh(1 / 4.45), per_ls1(1 / 0.002),
            per_ls2(1 / 5e-4), per_ls3(1 / 5e-4), per_r(1.0 / 25000), per_rp(1.0 / 50);
        constexpr real rg1(36.3), rg2(17.3), rg3(17.3), ri(50), rc(600), half(0.5);
        const auto signal = real(0.5) * myriad::sinpi(real(2000) * t);
        const R fast = p[carrier] * myriad::sinpi(real(20000) * t);
        const R d1 = diode<R>(y[2] - y[4] - y[6] - fast), d2 = diode<R>(y[5] - y[3] - y[6] - fast),
                d3 = diode<R>(y[3] + y[4] + y[6] + fast), d4 = diode<R>(y[6] - y[2] - y[5] + fast);
        return {per_c * (y[7] - half * y[9] + half * y[10] + y[13] - per_r * y[0]),
                per_c * (y[8] - half * y[11] + half * y[12] + y[14] - per_r * y[1]),
                per_cs * (y[9] - d1 + d4),
                per_cs * (d2 - y[10] - d3),
                per_cs * (y[11] + d1 - d3),
                per_cs * (d4 - y[12] - d2),
                per_cp * (d1 + d2 - d3 - d4 - per_rp * y[6]),
                -per_lh * y[0],
                -per_lh * y[1],
                per_ls2 * (half * y[0] - y[2] - rg2 * y[9]),
                per_ls3 * (y[3] - half * y[0] - rg3 * y[10]),
                per_ls2 * (half * y[1] - y[4] - rg2 * y[11]),
                per_ls3 * (y[5] - half * y[1] - rg3 * y[12]),
                per_ls1 * (signal - y[0] - (ri + rg1) * y[13]),
                -per_ls1 * (y[1] + (rc + rg1) * y[14])};
    }
};

}  // namespace problems
