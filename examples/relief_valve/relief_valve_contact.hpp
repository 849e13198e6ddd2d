// SPDX-License-Identifier: MIT
// The pressure relief valve with resting contact: where impacts accumulate, the valve comes to rest on its seat, and
// leaves it when the pressure lifts it. The model of relief_valve.hpp with a mode, an integer accessory.
#pragma once

#include "relief_valve.hpp"

// snippet: model
/// In flight like `relief_valve`. At rest y = v = 0, so that u' = beta q; the valve opens when the net force on it, u -
/// delta, becomes positive. An impact after which it rebounds slower than `slowest` is its last, if the net force keeps
/// it closed for longer than the remaining bounces can take.
struct relief_valve_contact : relief_valve {
    static constexpr bool accessories_are_outputs = false;  // rhs and events read the mode
    // those of `relief_valve`, followed by further ones
    enum shared { kappa, delta, beta, restitution, rest_band, slowest, n_shared };
    enum accessory { y_min, y_max, y_lowest, rest_at, u_contact, t_contact, time_at_rest, n_accessory };
    enum integer_accessory { steps_at_rest, impacts, rests, n_integer_accessory };
    enum event { section, seat, opening, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& s, const auto& p) {
        using myriad::select;
        const auto resting = p.integer_accessory[rests] == 1;
        const auto flight = relief_valve::rhs<R>(t, s, p);
        return {select(resting, R(0), flight[y]), select(resting, R(0), flight[v]), flight[u]};
    }

    /// Events irrelevant to a mode have no zero in it.
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        using myriad::select;
        const auto resting = p.integer_accessory[rests] == 1;
        return {select(resting, R(-1), s[v]), select(resting, R(1), s[y]),
                select(resting, s[u] - p.shared[delta], R(-1))};
    }

    MYRIAD_FUNCTION static void initialise(auto& lane) {
        relief_valve::initialise(lane);
        if (lane.phase == 0) lane.integer_accessory[rests] = 0;
        lane.accessory[u_contact] = lane.accessory[t_contact] = lane.accessory[time_at_rest] = 0;
    }

    MYRIAD_FUNCTION static void after_event(int event, auto& lane) {
        if (event == seat) {
            relief_valve::after_event(event, lane);
            lane.y[y] = 0;                              // exactly
            lane.integer_accessory[steps_at_rest] = 0;  // low bounces are not an equilibrium
            const auto closing = lane.shared[delta] - lane.y[u];
            const auto opens_in = closing / (lane.shared[beta] * lane.parameter[q]);
            const auto bounces = 4 * lane.y[v] / ((1 - lane.shared[restitution]) * closing);  // twice their duration
            if (!(lane.y[v] < lane.shared[slowest] && closing > 0 && 20 * bounces < opens_in)) return;
            lane.integer_accessory[rests] = 1;
            lane.y[v] = 0;
            lane.accessory[u_contact] = lane.y[u];
            lane.accessory[t_contact] = lane.t;
        } else if (event == opening) {
            lane.integer_accessory[rests] = 0;
            lane.y[u] = lane.shared[delta];  // exactly: the valve neither falls nor jumps
            lane.accessory[time_at_rest] = lane.t - lane.accessory[t_contact];
        }
    }
};
// end of snippet
