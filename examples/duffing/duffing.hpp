// SPDX-License-Identifier: MIT
// The Duffing oscillator of the MPGOS paper, with its events and accessories.
#pragma once

#include <myriad/model.hpp>

/// x'' + k x' - x + x^3 = B cos t, sampled once per period of the forcing. Events: local maxima of x, and zeros of x.
struct duffing {
    static constexpr bool accessories_are_outputs = true;  // hooks write them, rhs and events do not read them
    enum state { x, v, n_state };
    enum parameter { k, n_parameter };
    enum shared { B, n_shared };
    enum accessory { x_local_max, v_second_zero, x_global_max, n_accessory };
    enum integer_accessory { zeros, n_integer_accessory };
    enum event { local_maximum, zero, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        using myriad::cos;
        return {y[v], y[x] - y[x] * y[x] * y[x] - p[k] * y[v] + p.shared[B] * cos(t)};
    }

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[v], y[x]};
    }

    MYRIAD_FUNCTION static void initialise(auto& lane) {
        lane.accessory[x_local_max] = lane.y[x];
        lane.accessory[v_second_zero] = lane.y[v];
        lane.accessory[x_global_max] = lane.y[x];
        lane.integer_accessory[zeros] = 0;
    }

    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        lane.accessory[x_global_max] = myriad::max(lane.accessory[x_global_max], lane.y[x]);
    }

    MYRIAD_FUNCTION static void after_event(int event, auto& lane) {
        if (event == local_maximum) {
            lane.accessory[x_local_max] = myriad::max(lane.accessory[x_local_max], lane.y[x]);
        } else {
            lane.integer_accessory[zeros] += 1;
            if (lane.event_count[zero] == 2) lane.accessory[v_second_zero] = lane.y[v];
        }
    }
};
