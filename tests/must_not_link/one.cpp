// SPDX-License-Identifier: MIT
// A model of two components.
#include <myriad/instantiate.hpp>
#include <myriad/model.hpp>

struct oscillator {
    enum state { x, v, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[v], -y[x]};
    }
};

MYRIAD_INSTANTIATE(oscillator, myriad::runge_kutta_4)
