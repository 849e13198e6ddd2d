// expect: no member named.*accessory
// SPDX-License-Identifier: MIT
// A model that says that events do not see accessories does not see them.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    static constexpr bool accessories_are_outputs = true;
    enum state { x, n_state };
    enum accessory { threshold, n_accessory };
    enum event { crossing, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_event>{y[x] - p.accessory[threshold]};
    }
};

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)
