// SPDX-License-Identifier: MIT
// The model for timing dense output: the Duffing oscillator.
#pragma once

#include <myriad/model.hpp>

#include "problems/duffing.hpp"

struct forced_oscillator : problems::duffing {
    enum parameter { k, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return slope<R>(y, p[k], R(0.3) * myriad::cos(t));
    }
};
