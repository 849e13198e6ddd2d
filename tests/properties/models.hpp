// SPDX-License-Identifier: MIT
// The models whose results must depend only on the instance: one with events, summaries and an impact law with only +
// - * / and sqrt, one with events, hooks and elementary functions, and one without any hook.
#pragma once

#include <myriad/model.hpp>

#include "problems/lorenz.hpp"

namespace properties {

/// A ball in a quadratic potential that bounces off a wall, with drag; + - * / and sqrt only.
struct bouncer {
    enum state { x, v, n_state };
    enum parameter { k, x0, n_parameter };
    enum shared { drag, n_shared };
    enum accessory { v_max, path, energy_max, energy_max_at, x_max, x_min, work, n_accessory };
    enum integer_accessory { bounces, n_integer_accessory };
    enum event { wall, turning, n_event };
    enum observed { energy, position, n_observed };
    using to = myriad::over_phase;
    static constexpr myriad::summary summaries[] = {{energy, to::maximum, energy_max},
                                                    {energy, to::time_of_maximum, energy_max_at},
                                                    {position, to::maximum, x_max},
                                                    {position, to::minimum, x_min},
                                                    {energy, to::integral, work}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        using myriad::sqrt;
        return {y[v], -p[k] * (y[x] - p[x0]) - p.shared[drag] * y[v] / sqrt(R(1) + y[v] * y[v])};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[x], y[v]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_observed> observe(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v] * y[v] + p[k] * y[x] * y[x] / (R(1) + t), R(y[x])};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) { lane.accessory[v_max] = lane.y[v]; }
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        using myriad::abs;
        lane.accessory[v_max] = myriad::max(lane.accessory[v_max], lane.y[v]);
        lane.accessory[path] = lane.accessory[path] + abs(lane.h * lane.y[v]);
    }
    MYRIAD_FUNCTION static void after_event(int event, auto& lane) {
        if (event != wall) return;
        lane.y[v] = -lane.y[v] * lane.parameter[k] / (lane.parameter[k] + lane.shared[drag]);
        lane.integer_accessory[bounces] += 1;
    }
};

/// A forced pendulum with a stop and functions of all kinds; also bubble-like, with a power of the state.
struct mixed {
    enum state { q, w, n_state };
    enum parameter { f, n_parameter };
    enum accessory { q_max, n_accessory };
    enum event { section, stop, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        using myriad::cos, myriad::sin;
        return {y[w], R(0.3) * cos(p[f] * t) - sin(y[q]) - R(0.1) * y[w]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[w], y[q] - R(1)};
    }
    MYRIAD_FUNCTION static void after_event(int event, auto& lane) {
        if (event == stop) lane.y[w] = -lane.y[w] * real(0.7, lane.y[w]);
    }
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        using myriad::exp, myriad::pow;  // not in rhs, which is compiled once per stage
        const R value =
            lane.y[q] + R(0.01) * pow(R(2) + lane.y[q] * lane.y[q], R(-1.7)) - R(0.01) * exp(-lane.y[w] * lane.y[w]);
        lane.accessory[q_max] = myriad::max(lane.accessory[q_max], value);
    }

private:
    template <class R>
    MYRIAD_FUNCTION static R real(double value, R) {
        return static_cast<R>(value);
    }
};

using problems::lorenz;

}  // namespace properties
