// SPDX-License-Identifier: MIT
// Kepler's problem in the plane, alone and with the passage of the perihelion as an event.
#pragma once

#include <myriad/model.hpp>

namespace validation {

/// x'' = -x / r^3, y'' = -y / r^3.
struct orbit {
    enum state { x, y, u, v, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto&) {
        const R square = s[x] * s[x] + s[y] * s[y];
        const R inverse = R(1) / (square * myriad::sqrt(square));
        return {s[u], s[v], -(s[x] * inverse), -(s[y] * inverse)};
    }
};

/// The event is the passage of y = 0 from below, at the perihelion.
struct kepler : orbit {
    enum accessory { t_perihelion, n_accessory };
    enum integer_accessory { orbits, n_integer_accessory };
    enum event { perihelion, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return myriad::vec<R, n_event>{s[y]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        lane.accessory[t_perihelion] = 0;
        lane.integer_accessory[orbits] = 0;
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.accessory[t_perihelion] = lane.t;
        lane.integer_accessory[orbits] += 1;
    }
};

}  // namespace validation
