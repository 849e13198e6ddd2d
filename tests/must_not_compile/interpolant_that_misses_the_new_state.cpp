// expect: the interpolant does not end at the step.s new state
// SPDX-License-Identifier: MIT
// Samples and events would see a jump at the end of every step.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x]};
    }
};

struct torn : myriad::dormand_prince_5 {
    static constexpr double interpolant_weight(int stage, int power) {
        return myriad::dormand_prince_5::interpolant_weight(stage, power) + (stage == 3 && power == 2 ? 0.001 : 0.0);
    }
};

MYRIAD_INSTANTIATE(decay, torn)
