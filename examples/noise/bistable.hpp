// SPDX-License-Identifier: MIT
// A particle in a double well that noise drives from one well into the other.
#pragma once

// snippet: model
#include <myriad/model.hpp>

struct bistable {  // dx = (x - x^3) dt + sigma dW
    enum state { x, n_state };
    enum parameter { sigma, n_parameter };
    enum event { over, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{y[x] - y[x] * y[x] * y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> diffusion(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return myriad::vec<R, n_state>{p[sigma]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[x] - myriad::real_of<R>(1)};  // at the bottom of the other well
    }
};
// end of snippet
