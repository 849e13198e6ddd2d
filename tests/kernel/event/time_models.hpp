// SPDX-License-Identifier: MIT
// Two small models with one event that depends only on time: a smooth one, and one that jumps or is NaN; a pendulum; a
// ball between walls that its event function indicates only by its sign; and a state that settles at its event.
#pragma once

#include <myriad/model.hpp>

/// The record that the models of this file keep of their actions: their number and the times of the first few.
template <class Model>
MYRIAD_FUNCTION void log_action(auto& lane) {
    const int n = lane.integer_accessory[Model::fired];
    if (n < Model::log_length) lane.accessory[n] = lane.t;
    lane.integer_accessory[Model::fired] = n + 1;
}

/// g = amplitude cos t + c.
struct wave {
    enum state { x, n_state };
    enum parameter { amplitude, c, n_parameter };
    static constexpr int log_length = 8;
    enum accessory { n_accessory = log_length };
    enum integer_accessory { fired, n_integer_accessory };
    enum event { zero, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto t, const myriad::vec<R, n_state>&, const auto& p) {
        using myriad::cos;
        return myriad::vec<R, n_event>{p[amplitude] * cos(t) + p[c]};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) { log_action<wave>(lane); }
};

/// x' = -x. g has one value before, one at, and one after t = c; the values are integers, with `no_number` for NaN.
struct gate {
    enum state { x, n_state };
    enum parameter { c, n_parameter };
    enum shared_integer { before, at, after, n_shared_integer };
    static constexpr int no_number = 99;
    static constexpr int log_length = 8;
    enum accessory { n_accessory = log_length };
    enum integer_accessory { fired, n_integer_accessory };
    enum event { zero, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static R value(int code) {
        using real = myriad::real_of<R>;
        return R(code == no_number ? myriad::nan_of<real> : static_cast<real>(code));
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto t, const myriad::vec<R, n_state>&, const auto& p) {
        const auto& code = p.shared_integer;
        return myriad::vec<R, n_event>{myriad::select(
            t < p[c], value<R>(code[before]), myriad::select(t > p[c], value<R>(code[after]), value<R>(code[at])))};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) { log_action<gate>(lane); }
};

/// x'' = -9.8 sin x; the event is the turning point.
struct pendulum {
    enum state { x, v, n_state };
    enum event { turning, n_event };
    static constexpr int log_length = 4;
    enum accessory { n_accessory = log_length };
    enum integer_accessory { fired, n_integer_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        using myriad::sin;
        return {y[v], myriad::real_of<R>(-9.8) * sin(y[x])};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[v]};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) { log_action<pendulum>(lane); }
};

/// x'' = 0 between walls at 0 and 1: g is 1 between and -1 beyond them. At an event the ball reverses or passes
/// through.
struct walled {
    enum state { x, v, n_state };
    enum shared_integer { turns_round, n_shared_integer };
    enum event { wall, n_event };
    static constexpr int log_length = 16;
    enum accessory { n_accessory = log_length };
    enum integer_accessory { fired, n_integer_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[v], R(0)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{myriad::select((y[x] > R(0)) & (y[x] < R(1)), R(1), R(-1))};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        log_action<walled>(lane);
        if (lane.shared_integer[turns_round] != 0) lane.y[v] = -lane.y[v];
    }
};

/// x' = rest - x with a threshold: an integrate-and-fire model if it resets, a decay if rest and threshold are zero.
struct settling {
    enum state { x, n_state };
    enum parameter { rest, threshold, n_parameter };
    enum shared_integer { resets, n_shared_integer };
    enum event { fire, n_event };
    static constexpr int log_length = 4;
    enum accessory { n_accessory = log_length };
    enum integer_accessory { fired, n_integer_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{p[rest] - y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_event>{y[x] - p[threshold]};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        log_action<settling>(lane);
        if (lane.shared_integer[resets] != 0) lane.y[x] = 0;
    }
};
