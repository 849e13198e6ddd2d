// SPDX-License-Identifier: MIT
// A model that integrates nothing: its hook records the values of elementary functions on the device that runs it.
#pragma once

#include <myriad/model.hpp>

namespace function_values {

struct values {
    enum state { unused, n_state };
    enum parameter { x, y, n_parameter };
    enum accessory {
        power,
        inverse,
        inverse_root,
        sine,
        cosine,
        sine_alone,
        cosine_alone,
        sine_pi,
        cosine_pi,
        root,
        smaller,
        larger,
        n_accessory
    };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return {R(0) * s[unused]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        const auto angle = lane.parameter[x];
        const auto both = myriad::sincos(angle), both_pi = myriad::sincospi(angle);
        lane.accessory[power] = myriad::powr(angle, lane.parameter[y]);
        lane.accessory[inverse] = myriad::reciprocal(angle);
        lane.accessory[inverse_root] = myriad::rsqrt(angle);
        lane.accessory[sine] = both.sine;
        lane.accessory[cosine] = both.cosine;
        lane.accessory[sine_alone] = myriad::sin(angle);
        lane.accessory[cosine_alone] = myriad::cos(angle);
        lane.accessory[sine_pi] = both_pi.sine;
        lane.accessory[cosine_pi] = both_pi.cosine;
        lane.accessory[root] = myriad::sqrt(angle);
        lane.accessory[smaller] = myriad::min(angle, lane.parameter[y]);
        lane.accessory[larger] = myriad::max(angle, lane.parameter[y]);
    }
};

}  // namespace function_values
