// SPDX-License-Identifier: MIT
// Models with delays whose neighbouring solutions are followed: sensitivities and tangents.
#pragma once

#include <myriad/model.hpp>

namespace varied {

/// x' = -a x(t - tau) + x / 10: what the others have in common.
struct smooth {
    enum state { x, n_state };
    enum parameter { tau, a, n_parameter };
    enum delayed { before, n_delayed };

    MYRIAD_FUNCTION static int delayed_state(int) { return x; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const auto& p) {
        return p[tau];
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {R(0.1) * y[x] - p[a] * p.delayed[before]};
    }
};

/// With a history that does not end at the initial value, so that x' jumps where the beginning arrives.
struct jumping : smooth {
    template <class R>
    MYRIAD_FUNCTION static R history(int, const R& t, const auto& p) {
        return R(2) + myriad::sin(p[a] * t);
    }
};

/// With an event that reads the past and lets the state jump, which is seen a delay later.
struct kicked : jumping {
    enum event { low, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {p.delayed[before] - R(0.2) + R(0.1) * y[x]};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.y[x] = lane.y[x] * 1.2 + 0.5 * lane.delayed[before] + lane.parameter[a];
    }
};

/// Struck at t = a, where an event does nothing.
struct struck : jumping {
    enum stop { strike, n_stop };
    enum event { there, n_event };

    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, int number, const auto& p) {
        return p[a] + R(1000) * R(number);
    }
    MYRIAD_FUNCTION static void after_stop(int, int, auto& lane) { lane.y[x] += 1; }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto t, const myriad::vec<R, n_state>&, const auto& p) {
        return {t - p[a]};
    }
};

/// With a lag that depends on time and state.
struct bent {
    enum state { x, n_state };
    enum parameter { tau, a, n_parameter };
    enum delayed { before, n_delayed };

    MYRIAD_FUNCTION static int delayed_state(int) { return x; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const R& t, const myriad::vec<R, n_state>& y, const auto& p) {
        return p[tau] + R(0.2) * myriad::sin(t) + R(0.1) * y[x] * y[x];
    }
    template <class R>
    MYRIAD_FUNCTION static R history(int j, const R& t, const auto& p) {
        return jumping::history<R>(j, t, p);
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return smooth::rhs<R>(t, y, p);
    }
};

/// x' = c x(t - 1), whose largest exponent is the real part of Lambert's W at c.
struct exponential {
    enum state { x, n_state };
    enum parameter { c, n_parameter };
    enum delayed { before, n_delayed };

    MYRIAD_FUNCTION static int delayed_state(int) { return x; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const auto&) {
        return R(1);
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return {p[c] * p.delayed[before]};
    }
};

}  // namespace varied
