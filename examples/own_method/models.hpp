// SPDX-License-Identifier: MIT
// A pendulum of unit frequency, whose events are its passages through the lowest point.
#pragma once

#include <myriad/model.hpp>

struct pendulum {
    enum state { angle, speed, n_state };
    enum event { lowest_point, n_event };
    enum accessory { last_passage, n_accessory };
    enum integer_accessory { passages, n_integer_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        using myriad::sin;
        return {y[speed], -sin(y[angle])};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[angle]};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.accessory[last_passage] = lane.t;
        lane.integer_accessory[passages] += 1;
    }
};
