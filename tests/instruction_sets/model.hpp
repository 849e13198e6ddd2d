// SPDX-License-Identifier: MIT
// A model with all that kernels are made of: elementary functions, an event with an action, a hook after every step.
#pragma once

#include <myriad/model.hpp>

/// A driven pendulum that bounces off a wall at `side`; keeps its largest speed.
struct bouncing_pendulum {
    enum state { angle, speed, n_state };
    enum parameter { drive, side, n_parameter };
    enum accessory { fastest, n_accessory };
    enum event { wall, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        using myriad::cos, myriad::exp, myriad::pow, myriad::sin;
        const R friction = R(0.125) * exp(-pow(R(1) + y[angle] * y[angle], R(0.25)));
        return {y[speed], p[drive] * cos(t) - sin(y[angle]) - friction * y[speed]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[angle] - p[side]};
    }
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        lane.accessory[fastest] = myriad::max(lane.accessory[fastest], myriad::abs(lane.y[speed]));
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) { lane.y[speed] *= -0.9f; }
};
