// SPDX-License-Identifier: MIT
// Looks up the values of the past that a model's functions read, at the time at which they are evaluated.
#pragma once

#include <concepts>

#include "myriad/kernel/methods/stochastic_method.hpp"
#include "myriad/kernel/model/lane.hpp"
#include "myriad/kernel/model/past.hpp"
#include "myriad/kernel/scalar/dual.hpp"
#include "myriad/kernel/scalar/lanes.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Refuses delays where they are not known.
template <class Model, class Method>
constexpr bool check_delays() {
    static_assert(!has_delays<Model> || !stochastic_method<Method>,
                  "the model has delays, which methods for stochastic equations do not take");
    static_assert(!has_delays<Model> || n_unit<Model> == 0,
                  "the model has delays, which coupled units do not take: write it as one model");
    return true;
}
template <class Model, class Method>
inline constexpr bool delays_fit = check_delays<Model, Method>();

/// Whether lags depend on parameters and shared values alone: `lag(j, p)`. The jumps of the past then arrive at times
/// that are known.
template <class Model, class S>
inline constexpr bool has_constant_lags = requires(const inputs<Model, S>& p) {
    Model::template lag<S>(0, p);
};

/// How long ago delayed value j is.
template <class Model, class S>
MYRIAD_FUNCTION S lag_of(int j, const S& t, const vec<S, n_state<Model>>& y, const inputs<Model, S>& p) {
    if constexpr (has_constant_lags<Model, S>) {
        return Model::template lag<S>(j, p);
    } else {
        return Model::template lag<S>(j, t, y, p);
    }
}

/// Whether the model gives what delayed value j was before the beginning, by a function `history`; where that has some
/// of them alone, a function `has_history` says which. Others had the initial value.
template <class Model, int j>
MYRIAD_FUNCTION bool gives_history() {
    if constexpr (has_history<Model> && requires {
                      { Model::has_history(j) } -> std::same_as<bool>;
                  }) {
        return Model::has_history(j);
    } else {
        return has_history<Model>;
    }
}

/// Times at which the model's `history` is asked: its time does not begin again with a phase.
template <class Model, class S>
MYRIAD_FUNCTION S time_of_history(S time, const inputs<Model, S>& p) {
    MYRIAD_UNROLL
    for (int i = 0; i < lanes_of<S>; ++i) set_lane(time, i, get_lane(time, i) - p.past.moved_of(i));
    return time;
}

/// Looks up delayed value j at that time: `inside(lane, step, time)` in the step that it sees; before the beginning
/// `history(time)`, or `initial(lane)` of a state without one.
template <class Model, int j, class S, class Inside, class Initial, class History>
MYRIAD_FUNCTION S look_up(const S& time, const inputs<Model, S>& p, const Inside& inside, const Initial& initial,
                          [[maybe_unused]] const History& history) {
    S found = S(real_of<S>(0));
    mask_of<S> before = mask_of<S>(false);
    MYRIAD_UNROLL
    for (int i = 0; i < lanes_of<S>; ++i) {
        const auto at = get_lane(time, i);
        const auto& seen = p.past.template look<j>(i, at);
        set_lane(before, i, seen.number < 0);
        set_lane(found, i, seen.number >= 0 ? inside(i, seen, at) : initial(i));
    }
    if constexpr (gives_history<Model, j>()) {
        if (any(before)) found = select(before, history(detail::time_of_history<Model>(time, p)), found);
    }
    return found;
}
/// Delayed value j at that time, and its derivative by time.
template <class Model, int j, class S>
MYRIAD_FUNCTION S past_value(const S& time, const inputs<Model, S>& p) {
    return detail::look_up<Model, j>(
        time, p,
        [&](int i, const auto& seen, auto at) MYRIAD_LAMBDA { return p.past.template value_in<j>(i, seen, at); },
        [&](int i) MYRIAD_LAMBDA { return p.past.template initial_value<j>(i); },
        [&](const S& then) MYRIAD_LAMBDA {
            if constexpr (gives_history<Model, j>()) return S(Model::template history<S>(j, then, p));
            return then;
        });
}
template <class Model, int j, class S>
MYRIAD_FUNCTION S past_slope(const S& time, const inputs<Model, S>& p) {
    using R = real_of<S>;
    return detail::look_up<Model, j>(
        time, p,
        [&](int i, const auto& seen, auto at) MYRIAD_LAMBDA { return p.past.template slope_in<j>(i, seen, at); },
        [](int) MYRIAD_LAMBDA { return R(0); },
        [&](const S& then) MYRIAD_LAMBDA {
            if constexpr (gives_history<Model, j>())
                return S(Model::template history<dual<S>>(j, dual<S>(then, S(R(1))), p).derivative);
            return then;
        });
}

/// Sets `p.delayed` for functions that are evaluated at (t, y).
template <class Model, class S>
MYRIAD_FUNCTION void recall(const S& t, const vec<S, n_state<Model>>& y, const inputs<Model, S>& p) {
    if constexpr (has_delays<Model>) {
        using R = real_of<S>;
        const S slack = S(R(64) * epsilon_of<R>) * abs(t);
        static_for<0, n_delayed<Model>>([&](auto j) MYRIAD_LAMBDA {
            const S lag = detail::lag_of<Model>(j, t, y, p);
            const S time = t - lag;
            p.delayed[j] = detail::past_value<Model, decltype(j)::value>(time, p);
            const auto invalid = !(lag >= S(R(0)));
            const auto not_yet = time > p.past.reached + slack;
            if (MYRIAD_UNLIKELY(any(invalid | not_yet))) {
                MYRIAD_UNROLL
                for (int i = 0; i < lanes_of<S>; ++i) {
                    if (get_lane(invalid, i)) p.past.lane[i].trouble |= past_trouble::invalid;
                    if (get_lane(not_yet, i)) p.past.lane[i].trouble |= past_trouble::not_yet;
                }
            }
        });
    }
}

/// The inputs of functions that are evaluated with derivatives: those of the values of the past are along time.
template <class Model, class S>
struct past_in_motion : inputs<Model, S> {
    vec<dual<S>, n_delayed<Model>> delayed;  // in place of the values alone
};
template <class Model, class S>
MYRIAD_FUNCTION past_in_motion<Model, S> moving_past(const dual<S>& t, const vec<dual<S>, n_state<Model>>& y,
                                                     const inputs<Model, S>& p) {
    vec<S, n_state<Model>> at;
    for (int c = 0; c < n_state<Model>; ++c) at[c] = y[c].value;
    detail::recall<Model>(t.value, at, p);
    past_in_motion<Model, S> with{p, {}};
    static_for<0, n_delayed<Model>>([&](auto j) MYRIAD_LAMBDA {
        constexpr int number = decltype(j)::value;
        dual<S> time = t;
        if constexpr (has_constant_lags<Model, S>) {
            time.value = t.value - Model::template lag<S>(number, p);
        } else {
            time = t - Model::template lag<dual<S>>(number, t, y, p);
        }
        with.delayed[number] = dual<S>(p.delayed[number], detail::past_slope<Model, number>(time.value, p) *
                                                              static_cast<const S&>(time.derivative));
    });
    return with;
}

/// The lanes whose lookups may be believed, since the last call of `forget_trial`.
template <class Model, class S>
MYRIAD_FUNCTION mask_of<S> past_is_known(const lane_data<Model, S>& data) {
    mask_of<S> known = mask_of<S>(true);
    MYRIAD_UNROLL
    for (int i = 0; i < lanes_of<S>; ++i) set_lane(known, i, data.past.lane[i].trouble == past_trouble::none);
    return known;
}
/// A new trial begins.
template <class Model, class S>
MYRIAD_FUNCTION void forget_trial(lane_data<Model, S>& data) {
    MYRIAD_UNROLL
    for (int i = 0; i < lanes_of<S>; ++i) {
        data.past.lane[i].trouble = past_trouble::none;
        if (data.past.lane[i].has_trial) data.past.lane[i].forget();
        data.past.lane[i].has_trial = false;
    }
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
