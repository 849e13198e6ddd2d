// SPDX-License-Identifier: MIT
// The pressure relief valve as the peers integrate it: equations, and the actions of its events, one instance at a
// time.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "../cash_karp.hpp"
#include "../sweep.hpp"

namespace cpu_peers::relief_valve_case {

inline constexpr int n = 3;
inline constexpr double kappa = 1.25, delta = 10, beta = 20, restitution = 0.8;
inline constexpr double first_step = 1e-2;
inline constexpr double rest_band = 1e-6;            // a valve that stays within it
inline constexpr int rest_steps = 50;                // for so many steps is at rest, which ends the phase
inline constexpr int accumulation_limit = 25;        // impacts without leaving the seat; fewer than rest_steps
inline constexpr std::int64_t most_steps = 1000000;  // in one phase

/// Displacement y[0], velocity y[1], pressure y[2]; q is the flow.
template <class T>
CPU_PEERS_INLINE void slopes(const T* y, T q, T* dy) {
    dy[0] = y[1];
    dy[1] = T(-kappa) * y[1] - (y[0] + T(delta)) + y[2];
    dy[2] = T(beta) * (q - y[0] * std::sqrt(y[2]));
}

/// The valve's two events: `section`, where the velocity falls through zero, ends the phase; `seat`, where the
/// displacement does, is an impact. `value` and its `slope` along the solution.
enum event { section, seat, events };
template <class T>
CPU_PEERS_INLINE T value(int which, const T* y) {
    return which == section ? y[1] : y[0];
}
template <class T>
CPU_PEERS_INLINE T slope(int which, const T* y) {
    return which == section ? T(-kappa) * y[1] - (y[0] + T(delta)) + y[2] : y[1];
}

/// The length of the step from y at which an event function that is beyond its tolerance at the step's end falls to
/// within it: regula falsi (Illinois) on steps repeated by `step(length, end)`, with bisection where the start is on
/// the event itself. `guess` is the first length to try, 0 for none. Leaves the state there in `end`.
template <class T, class Step>
T locate(int which, const T* start, T h, T g_high, T allowed, T guess, T* end, Step&& step) {
    T low = 0, high = h, g_low = value(which, start);
    int same_side = 0;
    T length = guess;
    for (int i = 0; i < 200; ++i) {
        if (!(length > low && length < high)) {
            length = g_low > 0 ? high - g_high * (high - low) / (g_high - g_low) : T(0.5) * (low + high);
            if (!(length > low && length < high)) length = T(0.5) * (low + high);
        }
        step(length, end);
        const T g = value(which, end);
        const bool falls = slope(which, end) < 0;
        if (std::fabs(g) <= allowed && falls) return length;
        if (g < -allowed) {
            if (same_side < 0) g_low *= T(0.5);
            high = length;
            g_high = g;
            same_side = -1;
        } else {
            if (same_side > 0) g_high *= T(0.5);
            low = length;
            g_low = g;
            same_side = 1;
        }
        if (high - low <= 4 * std::numeric_limits<T>::epsilon() * high) break;
        length = 0;
    }
    step(low, end);
    return low;
}

/// The data of an instance besides its state, and the rules by which it continues; the same for all peers.
template <class T>
struct valve {
    T side[events];  // of zero, on which each event function was last seen beyond its tolerance: +1 or -1
    T lowest, highest, rest_at;
    int steps_at_rest, lingering;
    T allowed;  // tolerance of events

    void begin(const T* y, T event_tolerance) {
        allowed = event_tolerance;
        lingering = 0;
        for (int e = 0; e < events; ++e) side[e] = side_of(e, y);
    }
    void begin_phase(const T* y) {
        lowest = highest = rest_at = y[0];
        steps_at_rest = 0;
    }
    /// Whether a step to y crosses an event.
    bool crosses(int e, const T* y) const { return side[e] > 0 && value(e, y) < -allowed; }

    /// After an accepted step from `before` to y; `fired[e]` says which events are at its end. Returns true if the
    /// phase is over; sets `how` if the instance is over too.
    bool after_step(const T* before, T* y, const bool (&fired)[events], ending& how) {
        lowest = std::min(lowest, y[0]);
        highest = std::max(highest, y[0]);
        const bool rests = std::fabs(y[0] - rest_at) <= T(rest_band);
        rest_at = rests ? rest_at : y[0];
        steps_at_rest = rests ? steps_at_rest + 1 : 0;
        bool over = steps_at_rest >= rest_steps;
        for (int e = 0; e < events; ++e)
            if (std::fabs(value(e, y)) > allowed) side[e] = value(e, y) > 0 ? T(1) : T(-1);
        if (fired[section]) over = true;
        if (fired[seat]) {
            y[1] = T(-restitution) * y[1];
            lingering = std::fabs(before[0]) <= allowed ? lingering + 1 : 1;
            if (lingering >= accumulation_limit) {
                how = ending::accumulated;
                over = true;
            }
        }
        if (fired[seat] || fired[section])
            for (int e = 0; e < events; ++e)
                if (fired[e] || std::fabs(value(e, y)) > allowed || fired[seat]) side[e] = side_of(e, y);
        return over;
    }

private:
    T side_of(int e, const T* y) const {
        const T g = std::fabs(value(e, y)) > allowed ? value(e, y) : slope(e, y);
        return g > 0 ? T(1) : T(-1);
    }
};

outcome run_odeint(const sweep&);
outcome run_loop(const sweep&);
outcome run_reference(const sweep&);
__attribute__((weak)) outcome run_cvode(const sweep&);  // null if SUNDIALS was not found

}  // namespace cpu_peers::relief_valve_case
