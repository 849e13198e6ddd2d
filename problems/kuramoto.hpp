// SPDX-License-Identifier: MIT
// Kuramoto's oscillators, each coupled with all others through the mean field (Chemical Oscillations, Waves, and
// Turbulence, Springer, 1984): a sine and a cosine for each.
#pragma once

#include <myriad/model.hpp>

namespace problems {

template <int n>
struct kuramoto {
    enum state { n_state = n };
    enum parameter { coupling, n_parameter };
    enum shared { frequency, n_shared = n };  // of each oscillator

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        R sine[n], cosine[n], sines = R(0), cosines = R(0);
        MYRIAD_UNROLL
        for (int i = 0; i < n; ++i) {
            sine[i] = myriad::sin(y[i]);
            cosine[i] = myriad::cos(y[i]);
            sines += sine[i];
            cosines += cosine[i];
        }
        myriad::vec<R, n_state> slopes;
        MYRIAD_UNROLL
        for (int i = 0; i < n; ++i)
            slopes[i] = p.shared[frequency + i] + p[coupling] / R(n) * (sines * cosine[i] - cosines * sine[i]);
        return slopes;
    }
};

}  // namespace problems
