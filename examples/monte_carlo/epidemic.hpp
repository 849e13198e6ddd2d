// SPDX-License-Identifier: MIT
// An epidemic with uncertain parameters as a Myriad model: the SIR equations of Kermack and McKendrick, Proc. R. Soc. A
// 115 (1927) 700-721, in fractions of the population. Each instance draws its own parameters.
#pragma once

#include <myriad/model.hpp>
#include <myriad/random.hpp>

/// s are susceptible, i infectious, each for `duration` days on average, infecting R0 others if all are susceptible.
/// The number of infectious peaks where R0 s falls through 1.
struct epidemic {
    static constexpr bool writes_parameters = true;
    enum state { s, i, n_state };
    enum parameter { R0, duration, n_parameter };
    enum shared { R0_mean, R0_deviation, duration_least, duration_most, n_shared };
    enum shared_integer { seed, n_shared_integer };
    enum accessory { peak, day, n_accessory };  // the largest i, and when
    enum event { turning_point, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        const R infections = p[R0] * y[s] * y[i];
        return {-infections / p[duration], (infections - y[i]) / p[duration]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_event>{p[R0] * y[s] - R(1)};
    }

    // snippet: draws
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        myriad::random_numbers<double> random(static_cast<std::uint64_t>(lane.shared_integer[seed]), lane.index,
                                              lane.phase);
        lane.parameter[R0] = random.normal(lane.shared[R0_mean], lane.shared[R0_deviation]);
        lane.parameter[duration] = random.uniform(lane.shared[duration_least], lane.shared[duration_most]);
        lane.accessory[peak] = lane.y[i];
        lane.accessory[day] = lane.t;
    }
    // end of snippet
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.accessory[peak] = lane.y[i];
        lane.accessory[day] = lane.t;
    }
};
