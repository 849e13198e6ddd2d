// SPDX-License-Identifier: MIT
// A model with actions that wait in a queue.
#pragma once

#include <myriad/action_queue.hpp>
#include <myriad/model.hpp>

/// x' = 1 from 0. At t = 1 `count` actions are put, for the times in the parameters; they note their numbers, code = 10
/// * code + action + 1, the time, and what x was when they were put and when they ran. Times from 100 on are infinite.
struct queued {
    static constexpr int room = 3;
    using queue = myriad::action_queue<2, 1, room, 1>;
    enum state { x, n_state };
    enum parameter { n_parameter = 4 };
    enum accessory { last_time, sum, n_accessory = 2 + queue::n_accessory };
    enum integer_accessory { code, n_integer_accessory = 1 + queue::n_integer_accessory };
    enum shared_integer { count, seed, by_number, cancelled, n_shared_integer };
    enum stop { putting, running, n_stop };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto&) {
        return myriad::vec<R, n_state>{R(1)};
    }
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int stop, int number, const auto& p) {
        if (stop == running) return queue::next_time(p);
        return number == 0 ? R(1) : myriad::infinity_of<R>;
    }
    MYRIAD_FUNCTION static myriad::action after_stop(int stop, int, auto& lane) {
        using R = std::remove_cvref_t<decltype(lane.t)>;
        if (stop == putting) {
            lane.accessory[sum] = R(0);
            for (int k = 0; k < lane.shared_integer[count]; ++k) {
                const R time = lane.parameter[k] < R(100) ? lane.parameter[k] : myriad::infinity_of<R>;
                if (!queue::put(lane, k, time, {lane.y[x]})) return myriad::action::overflow;
            }
            queue::cancel(lane, lane.shared_integer[cancelled] - 1);
            return myriad::action::proceed;
        }
        const auto due = queue::take(
            lane, [&](int action) MYRIAD_LAMBDA { return lane.shared_integer[by_number] != 0 ? action : 0; },
            lane.shared_integer[seed]);
        lane.integer_accessory[code] = 10 * lane.integer_accessory[code] + due.action + 1;
        lane.accessory[last_time] = lane.t;
        lane.accessory[sum] += due.value[0] + R(10) * lane.y[x];
        return myriad::action::proceed;
    }
};
