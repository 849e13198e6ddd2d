// SPDX-License-Identifier: MIT
// The Duffing oscillator with its forcing as a parameter, and its highest maximum.
#pragma once

#include <myriad/model.hpp>

/// x'' + k x' - x + x^3 = B cos t. Event: local maxima of x, of which the highest in a phase is kept.
struct duffing {
    enum state { x, v, n_state };
    enum parameter { k, B, n_parameter };
    enum accessory { highest, n_accessory };
    enum event { maximum, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], y[x] - y[x] * y[x] * y[x] - p[k] * y[v] + p[B] * myriad::cos(t)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[v]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) { lane.accessory[highest] = lane.y[x]; }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.accessory[highest] = myriad::max(lane.accessory[highest], lane.y[x]);
    }
};
