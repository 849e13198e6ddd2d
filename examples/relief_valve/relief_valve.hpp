// SPDX-License-Identifier: MIT
// A pressure relief valve as a Myriad model: a mass on a spring over a reservoir, with impacts on its seat. Model of
// Hos and Champneys, Physica D 241 (2012) 2068-2076, dimensionless.
#pragma once

#include <myriad/model.hpp>

/// Displacement y, velocity v, pressure u; the flow q differs between instances. A phase ends at a local maximum of y
/// (event `section`, with `stop_after = 1`) or where the valve is at rest. At the seat y = 0 the velocity is reversed.
struct relief_valve {
    static constexpr bool accessories_are_outputs = true;
    enum state { y, v, u, n_state };
    enum parameter { q, n_parameter };
    enum shared { kappa, delta, beta, restitution, rest_band, n_shared };
    enum accessory { y_min, y_max, y_lowest, rest_at, n_accessory };
    enum integer_accessory { steps_at_rest, impacts, n_integer_accessory };
    enum event { section, seat, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        using myriad::sqrt;
        return {s[v], s[u] - p.shared[kappa] * s[v] - (s[y] + p.shared[delta]),
                p.shared[beta] * (p[q] - s[y] * sqrt(s[u]))};
    }

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return {s[v], s[y]};
    }

    /// y_min and y_max are those of the phase; y_lowest and `impacts` continue from phase to phase.
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        if (lane.phase == 0) {
            lane.accessory[y_lowest] = lane.y[y];
            lane.integer_accessory[impacts] = 0;
        }
        lane.accessory[y_min] = lane.accessory[y_max] = lane.accessory[rest_at] = lane.y[y];
        lane.integer_accessory[steps_at_rest] = 0;
    }

    /// Ends the phase of a valve that has stayed within `rest_band` for 50 steps.
    template <class R>
    MYRIAD_FUNCTION static myriad::mask_of<R> after_step(auto& lane) {
        using myriad::abs, myriad::max, myriad::min, myriad::select;
        using count = myriad::integer_of<R>;
        lane.accessory[y_min] = min(lane.accessory[y_min], lane.y[y]);
        lane.accessory[y_max] = max(lane.accessory[y_max], lane.y[y]);
        lane.accessory[y_lowest] = min(lane.accessory[y_lowest], lane.y[y]);
        const auto rests = abs(lane.y[y] - lane.accessory[rest_at]) <= R(lane.shared[rest_band]);
        count& steps = lane.integer_accessory[steps_at_rest];
        lane.accessory[rest_at] = select(rests, lane.accessory[rest_at], lane.y[y]);
        steps = select(rests, steps + count(1), count(0));
        return steps >= count(50);
    }

    MYRIAD_FUNCTION static void after_event(int event, auto& lane) {
        if (event != seat) return;
        lane.y[v] = -lane.shared[restitution] * lane.y[v];
        lane.integer_accessory[impacts] += 1;
    }
};
