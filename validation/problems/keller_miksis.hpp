// SPDX-License-Identifier: MIT
// The Keller-Miksis bubble under one or two frequencies.
#pragma once

#include <myriad/model.hpp>

#include "problems/keller_miksis.hpp"

namespace validation {

/// Stores the last maximum and minimum of the radius and their times.
struct keller_miksis : problems::keller_miksis {
    enum accessory { t_maximum, t_minimum, maximum, minimum, n_accessory };
    enum integer_accessory { maxima, minima, n_integer_accessory };
    enum event { largest, smallest, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& s, const auto& p) {
        using myriad::cospi, myriad::pow, myriad::sinpi;
        const R one = R(2) * t, two = R(2) * p[C11] * t + p[C12], inverse = R(1) / s[y];
        const R mach = p[C9] * s[v];
        const R numerator = (p[C0] + p[C1] * s[v]) * pow(s[y], -p[C10]) - p[C2] * (R(1) + mach) -
                            (p[C3] + p[C4] * s[v]) * inverse - (R(1.5) - R(0.5) * mach) * s[v] * s[v] -
                            (p[C5] * sinpi(one) + p[C6] * sinpi(two)) * (R(1) + mach) -
                            s[y] * (p[C7] * cospi(one) + p[C8] * cospi(two));
        return {s[v], numerator / (s[y] - mach * s[y] + p[C4] * p[C9])};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return {s[v], s[v]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        for (int a = 0; a < n_accessory; ++a) lane.accessory[a] = 0;
        lane.integer_accessory[maxima] = 0;
        lane.integer_accessory[minima] = 0;
    }
    MYRIAD_FUNCTION static void after_event(int event, auto& lane) {
        if (event == largest) {
            lane.accessory[t_maximum] = lane.t;
            lane.accessory[maximum] = lane.y[y];
            lane.integer_accessory[maxima] += 1;
        } else {
            lane.accessory[t_minimum] = lane.t;
            lane.accessory[minimum] = lane.y[y];
            lane.integer_accessory[minima] += 1;
        }
    }
};

}  // namespace validation
