// SPDX-License-Identifier: MIT
// The air pollution model of 25 reactions among 20 substances (Verwer, SIAM J. Sci. Comput. 15, 1994, 1243), problem
// POLLU of the Test Set for IVP Solvers.
#pragma once

#include <myriad/model.hpp>

namespace problems {

struct pollution {
    enum state { first, n_state = 20 };
    enum parameter { k1, n_parameter };  // the rate of the first reaction, by light; 0.35 in the test set
    static constexpr double t_end = 60;
    static constexpr double start[n_state] = {0, 0.2, 0, 0.04, 0, 0, 0.1,   0.3, 0.01, 0,
                                              0, 0,   0, 0,    0, 0, 0.007, 0,   0,    0};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        using real = myriad::real_of<R>;
        R r[26];  // rates of the reactions, from 1
        r[1] = p[k1] * y[0];
        r[2] = real(26.6) * y[1] * y[3];
        r[3] = real(12300.0) * y[4] * y[1];
        r[4] = real(0.00086) * y[6];
        r[5] = real(0.00082) * y[6];
        r[6] = real(15000.0) * y[6] * y[5];
        r[7] = real(0.00013) * y[8];
        r[8] = real(24000.0) * y[8] * y[5];
        r[9] = real(16500.0) * y[10] * y[1];
        r[10] = real(9000.0) * y[10] * y[0];
        r[11] = real(0.022) * y[12];
        r[12] = real(12000.0) * y[9] * y[1];
        r[13] = real(1.88) * y[13];
        r[14] = real(16300.0) * y[0] * y[5];
        r[15] = real(4800000.0) * y[2];
        r[16] = real(0.00035) * y[3];
        r[17] = real(0.0175) * y[3];
        r[18] = real(100000000.0) * y[15];
        r[19] = real(444000000000.0) * y[15];
        r[20] = real(1240.0) * y[16] * y[5];
        r[21] = real(2.1) * y[18];
        r[22] = real(5.78) * y[18];
        r[23] = real(0.0474) * y[0] * y[3];
        r[24] = real(1780.0) * y[18] * y[0];
        r[25] = real(3.12) * y[19];
        myriad::vec<R, n_state> f;
        f[0] = -r[1] - r[10] - r[14] - r[23] - r[24] + r[2] + r[3] + r[9] + r[11] + r[12] + r[22] + r[25];
        f[1] = -r[2] - r[3] - r[9] - r[12] + r[1] + r[21];
        f[2] = -r[15] + r[1] + r[17] + r[19] + r[22];
        f[3] = -r[2] - r[16] - r[17] - r[23] + r[15];
        f[4] = -r[3] + real(2) * r[4] + r[6] + r[7] + r[13] + r[20];
        f[5] = -r[6] - r[8] - r[14] - r[20] + r[3] + real(2) * r[18];
        f[6] = -r[4] - r[5] - r[6] + r[13];
        f[7] = r[4] + r[5] + r[6] + r[7];
        f[8] = -r[7] - r[8];
        f[9] = -r[12] + r[7] + r[9];
        f[10] = -r[9] - r[10] + r[8] + r[11];
        f[11] = r[9];
        f[12] = -r[11] + r[10];
        f[13] = -r[13] + r[12];
        f[14] = r[14];
        f[15] = -r[18] - r[19] + r[16];
        f[16] = -r[20];
        f[17] = r[20];
        f[18] = -r[21] - r[22] - r[24] + r[23] + r[25];
        f[19] = -r[25] + r[24];
        return f;
    }
};

}  // namespace problems
