// SPDX-License-Identifier: MIT
// Small models, one for each thing a model can do beside its right-hand side; docs/hooks_and_events.md shows most.
#pragma once

#include <myriad/action_queue.hpp>
#include <myriad/model.hpp>

// snippet: impact
/// A ball that bounces on the ground: x'' = -g, and v becomes -r v where x falls to zero.
struct bouncing_ball {
    enum state { x, v, n_state };
    enum parameter { r, n_parameter };
    enum shared { g, n_shared };
    enum accessory { t_impact, n_accessory };
    enum event { impact, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], R(-p.shared[g])};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[x]};
    }
    MYRIAD_FUNCTION static myriad::action after_event(int, auto& lane) {
        lane.y[x] = 0;
        lane.y[v] = -lane.parameter[r] * lane.y[v];
        lane.accessory[t_impact] = lane.t;
        return lane.event_count[impact] == 5 ? myriad::action::end_phase : myriad::action::proceed;
    }
};
// end of snippet

// snippet: observe
/// A damped mass, x'' = -x - 2 zeta x': how far it overshoots, when, and how much energy the damper has taken.
struct damped {
    static constexpr bool accessories_are_outputs = true;
    enum state { x, v, n_state };
    enum parameter { zeta, n_parameter };
    enum accessory { overshoot, t_overshoot, dissipated, n_accessory };
    enum observed { displacement, power, n_observed };
    static constexpr myriad::summary summaries[] = {
        {displacement, myriad::over_phase::minimum, overshoot},
        {displacement, myriad::over_phase::time_of_minimum, t_overshoot},
        {power, myriad::over_phase::integral, dissipated},
    };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], -y[x] - R(2) * p[zeta] * y[v]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_observed> observe(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[x], R(2) * p[zeta] * y[v] * y[v]};
    }
};
// end of snippet

// snippet: lyapunov
/// The Duffing oscillator with its tangent (a, b); each phase adds the growth of the tangent to `growth`.
struct tangent_duffing {
    enum state { x, v, a, b, n_state };
    enum parameter { k, n_parameter };
    enum shared { B, n_shared };
    enum accessory { growth, n_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], y[x] - y[x] * y[x] * y[x] - p[k] * y[v] + p.shared[B] * myriad::cos(t), y[b],
                (R(1) - R(3) * y[x] * y[x]) * y[a] - p[k] * y[b]};
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) {
        const auto length = myriad::hypot(lane.y[a], lane.y[b]);
        lane.y[a] /= length;
        lane.y[b] /= length;
        lane.accessory[growth] += myriad::log(length);
    }
};
// end of snippet

// snippet: after_step
/// x' = -k x, with its integral by the trapezoidal rule; a phase ends where x has fallen below a limit.
struct settling {
    static constexpr bool accessories_are_outputs = true;  // rhs does not read them
    enum state { x, n_state };
    enum parameter { k, n_parameter };
    enum shared { limit, n_shared };
    enum accessory { integral, x_before, n_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-p[k] * y[x]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        lane.accessory[integral] = 0;
        lane.accessory[x_before] = lane.y[x];
    }
    template <class R>  // generic: runs on a whole pack
    MYRIAD_FUNCTION static myriad::mask_of<R> after_step(auto& lane) {
        lane.accessory[integral] += R(0.5) * lane.h * (lane.accessory[x_before] + lane.y[x]);
        lane.accessory[x_before] = lane.y[x];
        return lane.y[x] < lane.shared[limit];  // a mask: true ends the phase of that lane
    }
};
// end of snippet

// snippet: continuation
/// Follows an equilibrium of x' = mu - x^3 as mu grows from phase to phase and the phases get longer.
struct continuation {
    static constexpr bool writes_parameters = true;
    static constexpr bool writes_time_domain = true;
    enum state { x, n_state };
    enum parameter { mu, n_parameter };
    enum shared { increment, n_shared };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{p[mu] - y[x] * y[x] * y[x]};
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) {
        lane.parameter[mu] += lane.shared[increment];
        lane.t_end += 1;  // of the next phase
    }
};
// end of snippet

// snippet: doses
/// A drug that is absorbed from the gut and eliminated from the blood; a dose goes into the gut every `interval`.
struct dosing {
    enum state { gut, blood, n_state };
    enum parameter { ka, ke, dose, interval, n_parameter };
    enum shared_integer { doses, n_shared_integer };
    enum stop { intake, n_stop };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {-p[ka] * y[gut], p[ka] * y[gut] - p[ke] * y[blood]};
    }
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, int number, const auto& p) {
        return myriad::recurring(number, R(0), p[interval], p.shared_integer[doses]);
    }
    MYRIAD_FUNCTION static void after_stop(int, int, auto& lane) { lane.y[gut] += lane.parameter[dose]; }
};
// end of snippet

// snippet: delayed
/// A tank that is filled until x rises through 1. The valve takes `lag` to close, and then x sinks.
struct slow_valve {
    using queue = myriad::action_queue<0, 1, 2>;  // up to two actions, from accessory 0 and integer accessory 1 on
    enum state { x, n_state };
    enum parameter { lag, n_parameter };
    enum accessory { n_accessory = queue::n_accessory };
    enum integer_accessory { closed, n_integer_accessory = 1 + queue::n_integer_accessory };
    enum event { full, n_event };
    enum stop { due, n_stop };
    enum later { close };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return myriad::vec<R, n_state>{myriad::select(p.integer_accessory[closed] != 0, R(-1), R(1))};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[x] - R(1)};
    }
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, int, const auto& p) {
        return queue::next_time(p);
    }
    MYRIAD_FUNCTION static myriad::action after_event(int, auto& lane) {
        const bool fits = queue::put(lane, close, lane.t + lane.parameter[lag]);
        return fits ? myriad::action::proceed : myriad::action::overflow;
    }
    MYRIAD_FUNCTION static void after_stop(int, int, auto& lane) {
        if (queue::take(lane).action == close) lane.integer_accessory[closed] = 1;
    }
};
// end of snippet

// snippet: select
/// A mass on a spring with a stop at x = gap: x'' = -x - K max(x - gap, 0).
struct stop_by_select {
    enum state { x, v, n_state };
    enum parameter { gap, n_parameter };
    enum shared { K, n_shared };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        const R contact = myriad::select(y[x] > p[gap], p.shared[K] * (y[x] - p[gap]), R(0));
        return {y[v], -y[x] - contact};
    }
};
// end of snippet

// snippet: scalar_only
/// The same with a branch: one instance at a time.
struct stop_by_branch {
    static constexpr bool scalar_only = true;
    enum state { x, v, n_state };
    enum parameter { gap, n_parameter };
    enum shared { K, n_shared };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        if (y[x] > p[gap]) return {y[v], -y[x] - p.shared[K] * (y[x] - p[gap])};
        return {y[v], -y[x]};
    }
};
// end of snippet
