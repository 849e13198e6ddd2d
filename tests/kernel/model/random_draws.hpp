// SPDX-License-Identifier: MIT
// A model that integrates nothing: its hooks record the random numbers that they draw.
#pragma once

#include <type_traits>

#include <myriad/kernel/model/random.hpp>
#include <myriad/model.hpp>

namespace random_draws {

struct draws {
    enum state { unused, n_state };
    enum shared_integer { seed, n_shared_integer };
    enum accessory { uniform, between, normal, scaled, at_the_end, n_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{R(0) * y[unused]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        using R = std::remove_cvref_t<decltype(lane.y[unused])>;
        myriad::random_numbers<R> random(static_cast<std::uint64_t>(lane.shared_integer[seed]), lane.index, lane.phase);
        lane.accessory[uniform] = random.uniform();
        lane.accessory[between] = random.uniform(R(-3), R(5));
        lane.accessory[normal] = random.normal();
        lane.accessory[scaled] = random.normal(R(10), R(3));
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) {
        using R = std::remove_cvref_t<decltype(lane.y[unused])>;
        myriad::random_numbers<R> random(static_cast<std::uint64_t>(lane.shared_integer[seed]), lane.index, lane.phase,
                                         4);
        lane.accessory[at_the_end] = random.normal();
    }
};

}  // namespace random_draws
