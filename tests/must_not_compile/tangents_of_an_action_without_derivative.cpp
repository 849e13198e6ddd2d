// expect: cannot convert .*dual<double.* to .const double|no viable conversion from .*dual<double
// SPDX-License-Identifier: MIT
// An action that converts the state to a plain number loses the derivative that moves the tangents.
#include "myriad/instantiate.hpp"
#include "myriad/kernel/model/tangent.hpp"
#include "myriad/model.hpp"

struct ball {
    enum state { x, v, n_state };
    enum event { impact, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[v], R(-1)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[x]};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        const double speed = lane.y[v];
        lane.y[v] = -speed;
    }
};

MYRIAD_INSTANTIATE(myriad::with_tangents<ball>, myriad::runge_kutta_4)
