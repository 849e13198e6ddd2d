// SPDX-License-Identifier: MIT
// The Duffing oscillator with events: maxima and zeros of x.
#pragma once

#include <myriad/model.hpp>

#include "problems/duffing.hpp"

namespace validation {

/// x'' + k x' - x + x^3 = B cos(omega t); stores the last maximum of x with its time, the time and speed of the last
/// rise of x through zero, and the numbers of both.
struct duffing : problems::duffing {
    enum parameter { k, n_parameter };
    enum shared { B, omega, n_shared };
    enum accessory { t_maximum, t_rise, maximum, v_rise, maxima_sum, n_accessory };
    enum integer_accessory { maxima, rises, n_integer_accessory };
    enum event { turning, rising, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return slope<R>(y, p[k], p.shared[B] * myriad::cos(p.shared[omega] * t));
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[v], y[x]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        if (lane.phase > 0) return;
        for (int a = 0; a < n_accessory; ++a) lane.accessory[a] = 0;
        lane.integer_accessory[maxima] = 0;
        lane.integer_accessory[rises] = 0;
    }
    MYRIAD_FUNCTION static void after_event(int event, auto& lane) {
        if (event == turning) {
            lane.accessory[t_maximum] = lane.t;
            lane.accessory[maximum] = lane.y[x];
            lane.accessory[maxima_sum] += lane.y[x];
            lane.integer_accessory[maxima] += 1;
        } else {
            lane.accessory[t_rise] = lane.t;
            lane.accessory[v_rise] = lane.y[v];
            lane.integer_accessory[rises] += 1;
        }
    }
};

}  // namespace validation
