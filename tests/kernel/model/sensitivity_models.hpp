// SPDX-License-Identifier: MIT
// Models with known sensitivities, for the tests of them.
#pragma once

#include <myriad/model.hpp>
#include <myriad/sensitivity.hpp>

namespace sensitivities {

/// x' = B - k x, w' = cos(k t) x.
struct decay {
    enum state { x, w, n_state };
    enum parameter { unused, k, n_parameter };
    enum shared { other, B, n_shared };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return {p.shared[B] - p[k] * y[x], myriad::cos(p[k] * t) * y[x]};
    }
};
using decay_by_domain =
    myriad::with_sensitivities<decay, myriad::time_domain::t_end, decay::k, myriad::time_domain::t_begin>;
using decay_by_all = myriad::with_sensitivities<decay, decay::k, decay::x, decay::B, decay::unused>;
using uncontrolled_decay = myriad::uncontrolled_sensitivities<decay, decay::k, decay::x, decay::B, decay::unused>;

/// A ball that bounces off a floor at a given height with restitution r; it notes the time and the speed of the last
/// impact, and counts impacts. With a `last` impact that ends the phase.
struct ball {
    enum state { x, v, n_state };
    enum parameter { r, floor, n_parameter };
    enum shared { g, n_shared };
    enum shared_integer { last, n_shared_integer };
    enum accessory { t_impact, speed, n_accessory };
    enum integer_accessory { bounces, n_integer_accessory };
    enum event { impact, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], R(-p.shared[g])};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_event>{y[x] - p[floor]};
    }
    MYRIAD_FUNCTION static myriad::action after_event(int, auto& lane) {
        lane.accessory[t_impact] = lane.t;
        lane.accessory[speed] = -lane.y[v];
        lane.y[v] = -lane.parameter[r] * lane.y[v];
        lane.integer_accessory[bounces] += 1;
        return lane.integer_accessory[bounces] == lane.shared_integer[last] ? myriad::action::end_phase
                                                                            : myriad::action::proceed;
    }
};
using ball_by_all = myriad::with_sensitivities<ball, ball::r, ball::floor, ball::g, ball::x, ball::v>;

/// x' = a t, whose phase ends when x reaches `top`; without an action. Beside it two events at a time.
struct ramp {
    enum state { x, n_state };
    enum parameter { a, top, before, after, n_parameter };
    enum event { early, there, late, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>&, const auto& p) {
        return myriad::vec<R, n_state>{R(p[a] * t)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return {R(t - p[before]), R(y[x] - p[top]), R(t - p[after])};
    }
};
using ramp_by_all = myriad::with_sensitivities<ramp, ramp::a, ramp::top, ramp::x>;
using ramp_by_times = myriad::with_sensitivities<ramp, ramp::top, ramp::before, ramp::after>;

/// A dose x -> x + amount at a time that is a parameter, and decay; the rate is an accessory that the start of the
/// phase computes from the state, and each phase ends with x -> x k.
struct dose {
    enum state { x, n_state };
    enum parameter { time, amount, k, n_parameter };
    enum accessory { rate, n_accessory };
    enum stop { given, n_stop };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-p.accessory[rate] * y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, int number, const auto& p) {
        return number == 0 ? R(p[time]) : myriad::infinity_of<R>;
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) { lane.accessory[rate] = lane.parameter[k] * lane.y[x]; }
    MYRIAD_FUNCTION static void after_stop(int, int, auto& lane) { lane.y[x] += lane.parameter[amount]; }
    MYRIAD_FUNCTION static void finalise(auto& lane) { lane.y[x] = lane.y[x] * lane.parameter[k]; }
};
using dose_by_all = myriad::with_sensitivities<dose, dose::time, dose::amount, dose::k, dose::x>;

/// x' = 3 (t - c)^2 from -c^3: x = (t - c)^3 rises through zero with no slope. The action notes the time, or adds to
/// another state.
struct inflection {
    enum state { x, w, n_state };
    enum parameter { c, jump, n_parameter };
    enum accessory { t_zero, highest, n_accessory };
    enum event { zero, n_event };
    enum observed { height, n_observed };
    static constexpr myriad::summary summaries[] = {{height, myriad::over_phase::maximum, highest}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>&, const auto& p) {
        const auto late = t - p[c];
        return {R(R(3) * late * late), R(1)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto t, const myriad::vec<R, n_state>&, const auto& p) {
        const auto late = t - p[c];
        return myriad::vec<R, n_event>{R(late * late * late)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_observed> observe(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_observed>{y[x]};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.accessory[t_zero] = lane.t;
        if (lane.parameter[jump] != 0) lane.y[w] += lane.parameter[jump] * lane.t;
    }
};
using inflection_by_c = myriad::with_sensitivities<inflection, inflection::c>;

/// x' = a t, which at `top` falls back to x / 5 + t / 10. It notes when it falls, the time domain that its hooks see,
/// and the integral of t x. Fall number `last` ends the phase.
struct saw {
    enum state { x, n_state };
    enum parameter { a, top, n_parameter };
    enum shared_integer { last, n_shared_integer };
    enum accessory { noted, begin, length, area, n_accessory };
    enum event { there, n_event };
    enum observed { moment, n_observed };
    static constexpr myriad::summary summaries[] = {{moment, myriad::over_phase::integral, area}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>&, const auto& p) {
        return myriad::vec<R, n_state>{R(p[a] * t)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_event>{y[x] - p[top]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_observed> observe(auto t, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_observed>{R(t * y[x])};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        lane.accessory[begin] = lane.t_begin * lane.t;
        lane.y[x] = lane.y[x] + lane.t / 8;
    }
    MYRIAD_FUNCTION static myriad::action after_event(int, auto& lane) {
        lane.accessory[noted] = lane.t * lane.t_end;
        lane.y[x] = lane.y[x] / 5 + lane.t / 10;
        return lane.event_count[there] == lane.shared_integer[last] ? myriad::action::end_phase
                                                                    : myriad::action::proceed;
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) { lane.accessory[length] = lane.t_end - lane.t_begin; }
};
using saw_by_domain =
    myriad::with_sensitivities<saw, saw::a, saw::top, saw::x, myriad::time_domain::t_begin, myriad::time_domain::t_end>;

}  // namespace sensitivities
