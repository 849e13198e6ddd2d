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
    return true;
}
template <class Model, class Method>
inline constexpr bool delays_fit = check_delays<Model, Method>();

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
template <class Model>
MYRIAD_FUNCTION bool gives_history([[maybe_unused]] int j) {
    if constexpr (has_history<Model> && requires {
                      { Model::has_history(j) } -> std::same_as<bool>;
                  }) {
        return Model::has_history(j);
    } else {
        return has_history<Model>;
    }
}

/// Whether it gives that of any delayed value.
template <class Model>
MYRIAD_FUNCTION bool gives_any_history() {
    bool any = false;
    if constexpr (has_history<Model>)
        detail::for_each_delayed<Model>([&](auto j) MYRIAD_LAMBDA { any = any || gives_history<Model>(j); });
    return any;
}

/// Times at which the model's `history` is asked: its time does not begin again with a phase.
template <class Model, class S>
MYRIAD_FUNCTION S time_of_history(S time, const inputs<Model, S>& p) {
    MYRIAD_UNROLL
    for (int i = 0; i < lanes_of<S>; ++i) set_lane(time, i, get_lane(time, i) - p.past.moved_of(i));
    return time;
}

/// Looks up delayed value j of functions at t at that time: `inside(lane, step, time)` in the step that it sees; before
/// the beginning `history(time)`, or `initial(step)` of a model without one.
template <class Model, class J, class S, class Inside, class Initial, class History>
MYRIAD_FUNCTION S look_up(J j, const S& time, const S& t, const inputs<Model, S>& p, const Inside& inside,
                          const Initial& initial, [[maybe_unused]] const History& history) {
    const bool has_given = gives_history<Model>(j);
    S found = S(real_of<S>(0));
    mask_of<S> before = mask_of<S>(false);
    MYRIAD_UNROLL
    for (int i = 0; i < lanes_of<S>; ++i) {
        const auto at = get_lane(time, i);
        const auto& seen = p.past.look(j, i, at, get_lane(t, i));
        set_lane(before, i, seen.number < 0);
        const auto value = inside(i, seen, at);
        set_lane(found, i, seen.number < 0 && !has_given ? initial(seen) : value);
    }
    if constexpr (has_history<Model>) {
        if (has_given && any(before)) found = select(before, history(detail::time_of_history<Model>(time, p)), found);
    }
    return found;
}
/// The history of delayed value j at that time, or its derivative of that order.
template <class Model, int order, class S>
MYRIAD_FUNCTION auto history_at(int j, const S& time, const auto& p) {
    if constexpr (order == 0) {
        return S(Model::template history<S>(j, time, p));
    } else {
        const dual<S> moving(time, S(real_of<S>(1)));
        return detail::history_at<Model, order - 1>(j, moving, p).derivative;
    }
}
/// The state of delayed value j of functions at t, at that time, or its derivative by time of that order.
template <class Model, int order, class J, class S>
MYRIAD_FUNCTION S state_of_past(J j, const S& time, const S& t, const inputs<Model, S>& p) {
    using R = real_of<S>;
    return detail::look_up<Model>(
        j, time, t, p,
        [&](int i, const auto& seen, auto at) MYRIAD_LAMBDA { return p.past.template value_in<order>(j, i, seen, at); },
        [](const auto& seen) MYRIAD_LAMBDA { return order == 0 ? seen.value : R(0); },
        [&](const S& then) MYRIAD_LAMBDA {
            if constexpr (has_history<Model>) {
                return S(detail::history_at<Model, order>(j, then, p));
            } else {
                return then;
            }
        });
}
/// Delayed value j itself, or its derivative of that order.
template <class Model, int order, class J, class S>
MYRIAD_FUNCTION S past_value(J j, const S& time, const S& t, const inputs<Model, S>& p) {
    if constexpr (has_delayed_slopes<Model>) {
        if (is_delayed_slope<Model>(j)) return detail::state_of_past<Model, order + 1>(j, time, t, p);
    }
    return detail::state_of_past<Model, order>(j, time, t, p);
}

/// Sets `p.delayed` for functions that are evaluated at (t, y).
template <class Model, class S>
MYRIAD_FUNCTION void recall(const S& t, const vec<S, n_state<Model>>& y, const inputs<Model, S>& p) {
    if constexpr (has_delays<Model>) {
        if (p.past.has_recalled(t)) return;
        detail::for_each_delayed<Model>([&](auto j) MYRIAD_LAMBDA {
            const S time = t - detail::lag_of<Model>(j, t, y, p);
            p.delayed[j] = detail::past_value<Model, 0>(j, time, t, p);
        });
        p.past.set_recalled(t);
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
    for (int c = 0; c < MYRIAD_LENGTH(n_state<Model>); ++c) at[c] = y[c].value;
    detail::recall<Model>(t.value, at, p);
    past_in_motion<Model, S> with{p, {}};
    detail::for_each_delayed<Model>([&](auto j) MYRIAD_LAMBDA {
        dual<S> time = t;
        if constexpr (has_constant_lags<Model, S>) {
            time.value = t.value - Model::template lag<S>(j, p);
        } else {
            time = t - Model::template lag<dual<S>>(j, t, y, p);
        }
        const S slope = detail::past_value<Model, 1>(j, time.value, t.value, p);
        with.delayed[j] = dual<S>(p.delayed[j], slope * static_cast<const S&>(time.derivative));
    });
    return with;
}

/// The lanes whose lookups may be believed, those of all threads of a team, since the last call of `forget_trial`.
template <class Model, class S>
MYRIAD_FUNCTION mask_of<S> past_is_known(const lane_data<Model, S>& data) {
    mask_of<S> known = mask_of<S>(true);
    MYRIAD_UNROLL
    for (int i = 0; i < lanes_of<S>; ++i) set_lane(known, i, data.past.lane[i].trouble == past_trouble::none);
    return team_for<Model>::all(known);
}
/// A new trial begins.
template <class Model, class S>
MYRIAD_FUNCTION void forget_trial(lane_data<Model, S>& data) {
    MYRIAD_UNROLL
    for (int i = 0; i < lanes_of<S>; ++i) {
        data.past.lane[i].trouble = past_trouble::none;
        data.past.lane[i].has_trial = false;
        data.past.lane[i].recalled = nan_of<real_of<S>>;
    }
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
