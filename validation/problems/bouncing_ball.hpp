// SPDX-License-Identifier: MIT
// The bouncing ball, whose impacts are known in closed form.
#pragma once

#include <myriad/model.hpp>

namespace validation {

/// x'' = -9.81; where x falls to zero, x = 0 and v becomes -r v. Ends at the twentieth impact.
struct bouncing_ball {
    enum state { x, v, n_state };
    enum parameter { restitution, n_parameter };
    enum accessory { t_1, t_2, t_5, t_10, t_20, n_accessory };
    enum integer_accessory { impacts, n_integer_accessory };
    enum event { impact, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[v], R(static_cast<myriad::real_of<R>>(-9.81))};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[x]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        for (int a = 0; a < n_accessory; ++a) lane.accessory[a] = 0;
        lane.integer_accessory[impacts] = 0;
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.y[x] = 0;
        lane.y[v] = -lane.parameter[restitution] * lane.y[v];
        const int count = static_cast<int>(lane.integer_accessory[impacts]) + 1;
        lane.integer_accessory[impacts] = count;
        if (count == 1) lane.accessory[t_1] = lane.t;
        if (count == 2) lane.accessory[t_2] = lane.t;
        if (count == 5) lane.accessory[t_5] = lane.t;
        if (count == 10) lane.accessory[t_10] = lane.t;
        if (count == 20) lane.accessory[t_20] = lane.t;
    }
};

}  // namespace validation
