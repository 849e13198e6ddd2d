// SPDX-License-Identifier: MIT
// A point that moves past levels, which its event functions signal by a jump or a smooth crossing: cases with several
// of them at one place.
#pragma once

#include <myriad/model.hpp>

/// x' = v, v' = a. Three event functions of the levels c_j, each of the kind chosen by a shared integer. Every action
/// is logged, and then does what another shared integer selects.
struct levels {
    enum state { x, v, n_state };
    enum parameter { a, c0, c1, c2, n_parameter };
    enum shared_integer { kind, action = kind + 3, counts_steps = action + 3, n_shared_integer };
    static constexpr int log_length = 8;
    enum accessory { at, n_accessory = at + log_length };
    enum integer_accessory { steps, fired, which, n_integer_accessory = which + log_length };
    enum event { first, second, third, n_event };
    /// A jump up or down where x passes the level, the same detected by the square of x (whose rounding differs), a
    /// jump where t passes it, a smooth crossing, a double root, and none.
    enum kinds { up, down, square_up, time_up, smooth, touch, none };
    enum actions { log, step_back, turn_round, stand_on_level, bounce };  // bounce: with half the speed

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], p[a]};
    }
    template <class R>
    MYRIAD_FUNCTION static R function(int which_kind, const R& c, const auto& t, const myriad::vec<R, n_state>& y) {
        switch (which_kind) {
            case up:
                return myriad::select(y[x] < c, R(-1), R(1));
            case down:
                return myriad::select(y[x] < c, R(1), R(-1));
            case square_up:
                return myriad::select(y[x] * y[x] < c * c, R(-1), R(1));
            case time_up:
                return myriad::select(t < c, R(-1), R(1));
            case smooth:
                return y[x] - c;
            case touch:
                return (y[x] - c) * (y[x] - c);
            default:
                return R(1);
        }
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        myriad::vec<R, n_event> g;
        for (int j = 0; j < n_event; ++j) g[j] = function<R>(p.shared_integer[kind + j], R(p[c0 + j]), R(t), y);
        return g;
    }
    /// Changes inputs of events, on request.
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        if (lane.shared_integer[counts_steps] != 0) lane.integer_accessory[steps] += 1;
    }
    MYRIAD_FUNCTION static void after_event(int event, auto& lane) {
        const int n = lane.integer_accessory[fired];
        if (n < log_length) {
            lane.accessory[at + n] = lane.t;
            lane.integer_accessory[which + n] = event;
        }
        lane.integer_accessory[fired] = n + 1;
        const int what = lane.shared_integer[action + event];
        if (what == step_back) lane.y[x] -= 2;
        if (what == turn_round) lane.y[v] = -lane.y[v];
        if (what == bounce) lane.y[v] = -lane.y[v] / 2;
        if (what == stand_on_level) lane.y[x] = lane.parameter[c0 + event];
    }
};
