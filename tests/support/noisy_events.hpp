// SPDX-License-Identifier: MIT
// Stochastic equations with events whose first passages have known laws.
#pragma once

#include <myriad/model.hpp>

namespace noisy {

/// dx = (drift - pull x) dt + sigma dW between two walls. An action counts the passages, adds up their times and, where
/// `resets` is 1, sets x to 0; a stop time does so again after the first, by `rest` later if that is not 0.
struct walled {
    enum state { x, n_state };
    enum parameter { drift, pull, sigma, upper, lower, resets, rest, n_parameter };
    enum accessory { passages, last, wakes_at, n_accessory };
    enum event { above, below, n_event };
    enum stop { wake, n_stop };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {p[drift] - p[pull] * y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> diffusion(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return {p[sigma]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[x] - p[upper], y[x] - p[lower]};
    }
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, int number, const auto& p) {
        return myriad::recurring(number, p.accessory[wakes_at], p.accessory[wakes_at], 1);
    }
    MYRIAD_FUNCTION static void after_stop(int, int, auto& lane) { lane.y[x] = 0; }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        lane.accessory[passages] = 0;
        lane.accessory[last] = 0;
        lane.accessory[wakes_at] = 1e9F;  // never
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.accessory[passages] += 1;
        lane.accessory[last] = lane.t;
        if (lane.parameter[resets] > 0) lane.y[x] = 0;
        if (lane.parameter[rest] > 0) lane.accessory[wakes_at] = lane.t + lane.parameter[rest];
    }
};

/// Two states whose processes are shared, with a circle around the origin and a line.
struct in_a_disc {
    enum state { x, z, n_state };
    enum parameter { radius, line, n_parameter };
    enum noise { first, second, n_noise };
    enum event { circle, side, n_event };
    static constexpr double cosine = 0.6, sine = 0.8;

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto&) {
        return {R(0), R(0)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<myriad::vec<R, n_noise>, n_state> diffusion(auto, const myriad::vec<R, n_state>&,
                                                                                   const auto&) {
        return {myriad::vec<R, n_noise>{R(cosine), R(sine)}, myriad::vec<R, n_noise>{R(-sine), R(cosine)}};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {p[radius] - myriad::sqrt(y[x] * y[x] + y[z] * y[z] + R(1e-12)), y[x] + y[z] - p[line]};
    }
};

/// A particle that falls on a floor under noise of its velocity: the event's function has none.
struct bouncing {
    enum state { height, velocity, n_state };
    enum parameter { gravity, friction, sigma, restitution, n_parameter };
    enum accessory { bounces, lowest, n_accessory };
    enum event { floor, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[velocity], -p[gravity] - p[friction] * y[velocity]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> diffusion(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return {R(0), p[sigma]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[height]};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        // Noise may have turned the velocity already in the step that leads here.
        lane.y[velocity] = lane.parameter[restitution] * myriad::abs(lane.y[velocity]);
        lane.accessory[bounces] += 1;
    }
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        if (lane.y[height] < lane.accessory[lowest]) lane.accessory[lowest] = lane.y[height];
    }
};

/// Growth dx = rate x dt + sigma x dW up to a level, and a time.
struct growing {
    enum state { x, n_state };
    enum parameter { rate, sigma, level, time, n_parameter };
    enum event { reached, late, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {p[rate] * y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> diffusion(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {p[sigma] * y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[x] - p[level], R(t - p[time])};
    }
};

/// A Wiener process with a drift, and how far it goes; and twice its value with the other sign.
struct wandering {
    enum state { x, n_state };
    enum parameter { drift, n_parameter };
    enum observed { place, twice_back, n_observed };
    enum accessory { highest, when_highest, lowest, when_lowest, back, n_accessory };
    static constexpr myriad::summary summaries[] = {{place, myriad::over_phase::maximum, highest},
                                                    {place, myriad::over_phase::time_of_maximum, when_highest},
                                                    {place, myriad::over_phase::minimum, lowest},
                                                    {place, myriad::over_phase::time_of_minimum, when_lowest},
                                                    {twice_back, myriad::over_phase::maximum, back}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return {R(p[drift])};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> diffusion(auto, const myriad::vec<R, n_state>&, const auto&) {
        return {R(1)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_observed> observe(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[x], R(-2) * y[x]};
    }
};

}  // namespace noisy
