// SPDX-License-Identifier: MIT
// The pressure relief valve as a Myriad model, with its Poincare section, its impacts and its rest.
#pragma once

#include <myriad/model.hpp>

namespace cpu_peers {

/// Displacement y, velocity v, pressure u. Event `section` (v falling) ends a phase by its count, `seat` (y falling) is
/// an impact; a valve that does not move for 50 steps also ends its phase.
struct relief_valve_model {
    static constexpr bool accessories_are_outputs = true;
    static constexpr bool rare_events = true;
    enum state { y, v, u, n_state };
    enum parameter { q, n_parameter };
    enum shared { kappa, delta, beta, restitution, rest_band, n_shared };
    enum accessory { lowest, highest, rest_at, n_accessory };
    enum integer_accessory { steps_at_rest, n_integer_accessory };
    enum event { section, seat, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        using myriad::fma, myriad::sqrt;
        return {s[v], fma(R(-p.shared[kappa]), s[v], s[u] - (s[y] + p.shared[delta])),
                p.shared[beta] * fma(-s[y], sqrt(s[u]), p[q])};
    }

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return {s[v], s[y]};
    }

    MYRIAD_FUNCTION static void initialise(auto& lane) {
        lane.accessory[lowest] = lane.y[y];
        lane.accessory[highest] = lane.y[y];
        lane.accessory[rest_at] = lane.y[y];
        lane.integer_accessory[steps_at_rest] = 0;
    }

    template <class R>
    MYRIAD_FUNCTION static myriad::mask_of<R> after_step(auto& lane) {
        using myriad::abs, myriad::max, myriad::min, myriad::select;
        using count = myriad::integer_of<R>;
        lane.accessory[lowest] = min(lane.accessory[lowest], lane.y[y]);
        lane.accessory[highest] = max(lane.accessory[highest], lane.y[y]);
        const auto rests = abs(lane.y[y] - lane.accessory[rest_at]) <= R(lane.shared[rest_band]);
        count& steps = lane.integer_accessory[steps_at_rest];
        lane.accessory[rest_at] = select(rests, lane.accessory[rest_at], lane.y[y]);
        steps = select(rests, steps + count(1), count(0));
        return steps >= count(50);
    }

    MYRIAD_FUNCTION static void after_event(int event, auto& lane) {
        if (event == seat) lane.y[v] = -lane.shared[restitution] * lane.y[v];
    }
};

}  // namespace cpu_peers
