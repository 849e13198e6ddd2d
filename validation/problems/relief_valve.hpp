// SPDX-License-Identifier: MIT
// The pressure relief valve with impacts on its seat, over a given time. Model of Hos and Champneys, Physica D 241
// (2012) 2068-2076, dimensionless.
#pragma once

#include <myriad/model.hpp>

namespace validation {

/// Displacement y, velocity v, pressure u. At the seat y = 0 the velocity is reversed; stores the last impact's time
/// and speed, and the last maximum of y with its time.
struct relief_valve {
    enum state { y, v, u, n_state };
    enum parameter { q, n_parameter };
    enum shared { kappa, delta, beta, restitution, n_shared };
    enum accessory { t_maximum, t_impact, maximum, impact_speed, n_accessory };
    enum integer_accessory { maxima, impacts, n_integer_accessory };
    enum event { section, seat, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {s[v], s[u] - p.shared[kappa] * s[v] - (s[y] + p.shared[delta]),
                p.shared[beta] * (p[q] - s[y] * myriad::sqrt(s[u]))};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return {s[v], s[y]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        for (int a = 0; a < n_accessory; ++a) lane.accessory[a] = 0;
        lane.integer_accessory[maxima] = 0;
        lane.integer_accessory[impacts] = 0;
    }
    MYRIAD_FUNCTION static void after_event(int event, auto& lane) {
        if (event == section) {
            lane.accessory[t_maximum] = lane.t;
            lane.accessory[maximum] = lane.y[y];
            lane.integer_accessory[maxima] += 1;
        } else {
            lane.accessory[t_impact] = lane.t;
            lane.accessory[impact_speed] = -lane.y[v];
            lane.integer_accessory[impacts] += 1;
            lane.y[y] = 0;
            lane.y[v] = -lane.shared[restitution] * lane.y[v];
        }
    }
};

}  // namespace validation
