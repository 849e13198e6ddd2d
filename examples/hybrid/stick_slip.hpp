// SPDX-License-Identifier: MIT
// A block on a moving belt, held by a spring: the textbook hybrid system. Its mode, sticking or sliding, is an integer
// accessory that the right-hand side reads and events switch.
#pragma once

#include <myriad/model.hpp>

// snippet: model
/// x'' = -x + friction. While the block slides, friction is `kinetic`, directed towards the belt's speed `belt`; while
/// it sticks, friction is the force that keeps it at the belt's speed, up to `breakaway`.
struct stick_slip {
    enum state { x, v, n_state };
    enum parameter { belt, n_parameter };
    enum shared { kinetic, breakaway, n_shared };
    enum accessory { t_slip, x_slip, x_stick, period, n_accessory };
    enum integer_accessory { sticks, slips, n_integer_accessory };
    enum event { grip, slip, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        const auto sticking = p.integer_accessory[sticks] == 1;
        return {myriad::select(sticking, p[belt], y[v]), myriad::select(sticking, R(0), p.shared[kinetic] - y[x])};
    }
    /// In each mode, the event that ends the other mode has no zero.
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        const auto sticking = p.integer_accessory[sticks] == 1;
        return {myriad::select(sticking, R(-1), y[v] - p[belt]),
                myriad::select(sticking, y[x] - p.shared[breakaway], R(-1))};
    }
    MYRIAD_FUNCTION static void after_event(int event, auto& lane) {
        if (event == grip) {
            lane.integer_accessory[sticks] = 1;
            lane.y[v] = lane.parameter[belt];  // exactly
            lane.accessory[x_stick] = lane.y[x];
        } else {
            lane.integer_accessory[sticks] = 0;
            lane.integer_accessory[slips] += 1;
            lane.accessory[period] = lane.t - lane.accessory[t_slip];
            lane.accessory[t_slip] = lane.t;
            lane.accessory[x_slip] = lane.y[x];
        }
    }
};
// end of snippet
