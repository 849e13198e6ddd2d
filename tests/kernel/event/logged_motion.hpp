// SPDX-License-Identifier: MIT
// A model whose motion, event functions and actions are chosen at run time, so that one compilation serves many tests
// of events. It logs every action: which event, when, and how far its function was past zero.
#pragma once

#include <myriad/model.hpp>

/// x' = v, v' = acceleration - stiffness x. Three event functions g_j = X x + V v + T t + Q (t - 1)^2 - c_j, with the
/// coefficients X, V, T, Q shared and the constant c_j of each instance.
struct logged_motion {
    enum state { x, v, n_state };
    enum parameter { acceleration, stiffness, c0, c1, c2, n_parameter };
    static constexpr int n_event_shared = 4;
    enum shared { restitution, of_x, of_v, of_t, of_square, n_shared = of_x + 3 * n_event_shared };
    enum shared_integer { action_0, action_1, action_2, n_shared_integer };
    static constexpr int log_length = 24;
    enum accessory { smallest_x, beyond, gap, at, n_accessory = at + log_length };
    enum integer_accessory { fired, which, n_integer_accessory = which + log_length };
    enum event { first, second, third, n_event };
    enum actions { log, bounce, zero_x, lower_x, jump_v, end_phase, end_instance };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], p[acceleration] - p[stiffness] * y[x]};
    }

    template <class R>
    MYRIAD_FUNCTION static R function(int j, const auto& t, const myriad::vec<R, n_state>& y, const auto& shared,
                                      const auto& c) {
        using real = myriad::real_of<R>;
        const auto* q = shared + n_event_shared * j;
        const auto u = t - real(1);
        return (q[of_x] * y[x] + q[of_v] * y[v] + q[of_t] * t + q[of_square] * u * u) - c;
    }

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return {function<R>(0, t, y, p.shared, p[c0]), function<R>(1, t, y, p.shared, p[c1]),
                function<R>(2, t, y, p.shared, p[c2])};
    }

    MYRIAD_FUNCTION static void after_step(auto& lane) {
        lane.accessory[smallest_x] = myriad::min(lane.accessory[smallest_x], lane.y[x]);
    }

    MYRIAD_FUNCTION static myriad::action after_event(int event, auto& lane) {
        const int n = lane.integer_accessory[fired];
        if (n < log_length) {
            lane.accessory[at + n] = lane.t;
            lane.integer_accessory[which + n] = event;
        }
        lane.integer_accessory[fired] = n + 1;
        // beyond: how far the function of x has passed zero in the direction of the motion
        const auto g = function<std::remove_cvref_t<decltype(lane.t)>>(event, lane.t, lane.y, lane.shared,
                                                                       lane.parameter[c0 + event]);
        const auto passed = lane.shared[n_event_shared * event + of_x] * lane.y[v] * lane.h > 0 ? g : -g;
        lane.accessory[beyond] = myriad::max(lane.accessory[beyond], passed);
        lane.accessory[gap] = myriad::max(lane.accessory[gap], -passed);

        const int what = lane.shared_integer[action_0 + event];
        if (what == bounce) lane.y[v] = -lane.shared[restitution] * lane.y[v];
        if (what == zero_x) lane.y[x] = 0;
        if (what == lower_x) lane.y[x] -= 1;
        if (what == jump_v) lane.y[v] += 1;
        if (what == end_phase) return myriad::action::end_phase;
        if (what == end_instance) return myriad::action::end_instance;
        return myriad::action::proceed;
    }
};
