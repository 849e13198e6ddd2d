// SPDX-License-Identifier: MIT
// Models for the tests of first steps: a slope that is a parameter, and an oscillator.
#pragma once

#include <myriad/model.hpp>

namespace first_steps {

struct line {
    enum state { y, n_state };
    enum parameter { slope, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return myriad::vec<R, n_state>{R(p[slope])};
    }
};

struct swing {
    enum state { x, v, n_state };
    enum parameter { rate, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], -p[rate] * p[rate] * y[x]};
    }
};

/// A slope that is nearly zero at whole times: sin^2(pi t) + drift.
struct pulses {
    enum state { y, n_state };
    enum parameter { drift, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(const auto& t, const myriad::vec<R, n_state>&, const auto& p) {
        const auto s = myriad::sinpi(t);
        return myriad::vec<R, n_state>{R(s * s + p[drift])};
    }
};

/// Van der Pol's oscillator, whose jumps take 1 / mu of the time between them.
struct relaxation {
    enum state { x, v, n_state };
    enum parameter { mu, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], p[mu] * (R(1) - y[x] * y[x]) * y[v] - y[x]};
    }
};

}  // namespace first_steps
