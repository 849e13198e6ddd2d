// SPDX-License-Identifier: MIT
// The past of neighbouring solutions: what a model with tangents or sensitivities has for delayed values. A
// neighbouring solution sees v(t - lag) farther away and, where its time is later or its lag shorter by dt, another
// x'(t - lag) dt. Where a jump of the past arrives at another time than in the solution itself, its distance jumps by
// the difference of the slopes times that, as at an event (Baker, Paul, SIAM J. Sci. Comput. 18 (1997) 305-314).
#pragma once

#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/model/forwarded_hooks.hpp"
#include "myriad/kernel/model/past_layout.hpp"
#include "myriad/kernel/model/recall.hpp"
#include "myriad/kernel/model/tangent_lane.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Where the delayed values are: those of Model, the same of each direction, and, where the times that are seen may
/// move, the slopes of the states at them.
template <class Model, class Directions>
struct varied_past {
    static constexpr int own = n_delayed<Model>, count = Directions::count, n = n_state<Model>;
    static constexpr bool times_move =
        Directions::keeps_times || has_events<Model> || !has_constant_lags<Model, double>;
    static constexpr int first_slope = own * (1 + count), all = first_slope + (times_move ? own : 0);

    /// Delayed value k at a time t and state y with derivatives in direction i; -1: only time and state have any.
    template <int i, class S>
    static MYRIAD_FUNCTION vec<dual<S>, own> along(const auto& p, const auto& from, const dual<S>& t,
                                                   const vec<dual<S>, n>& y) {
        vec<dual<S>, own> moved;
        static_for<0, own>([&](auto k) MYRIAD_LAMBDA {
            S derivative = S(real_of<S>(0));
            if constexpr (i >= 0) derivative = from.delayed[own * (1 + i) + k];
            if constexpr (times_move)
                derivative =
                    fma(S(from.delayed[first_slope + k]), t.derivative - lag(k, t, y, p).derivative, derivative);
            moved[k] = dual<S>(S(from.delayed[k]), derivative);
        });
        return moved;
    }
    /// The same at t, in all directions at once.
    template <class S>
    static MYRIAD_FUNCTION vec<moving_number<Directions, S>, own> along_all(
        const auto& p, const auto& from, const S& t, const vec<moving_number<Directions, S>, n>& y) {
        using number = moving_number<Directions, S>;
        vec<number, own> moved;
        static_for<0, own>([&](auto k) MYRIAD_LAMBDA {
            auto derivatives = partials<S, count>::each(
                [&](auto i) MYRIAD_LAMBDA { return partial<S>(S(from.delayed[own * (1 + i) + k])); });
            if constexpr (times_move)
                derivatives = derivatives - lag(k, number(t), y, p).derivative * S(from.delayed[first_slope + k]);
            moved[k] = number(S(from.delayed[k]), derivatives);
        });
        return moved;
    }
    /// How long ago delayed value k is, with derivatives.
    template <class D>
    static MYRIAD_FUNCTION D lag(int k, const D& t, const vec<D, n>& y, const auto& p) {
        if constexpr (has_constant_lags<Model, double>) {
            return D(Model::template lag<D>(k, p));
        } else {
            return D(Model::template lag<D>(k, t, y, p));
        }
    }
};

/// The inputs of Model in direction i, taken from those of a model W that has directions, for functions at (t, y).
template <class Model, class Directions, int i, class S>
MYRIAD_FUNCTION decltype(auto) inputs_along(const auto& from, [[maybe_unused]] const dual<S>& t,
                                            [[maybe_unused]] const vec<dual<S>, n_state<Model>>& y) {
    if constexpr (has_delays<Model>) {
        auto p = detail::inputs_along<Model, Directions, i, S>(from);
        p.delayed = varied_past<Model, Directions>::template along<i>(p, from, t, y);
        return p;
    } else {
        return detail::inputs_along<Model, Directions, i, S>(from);
    }
}
/// The same along the solution itself, where nothing moves but time, state and past.
template <class Model, class Directions, class S>
MYRIAD_FUNCTION auto inputs_along_solution(const auto& from, [[maybe_unused]] const dual<S>& t,
                                           [[maybe_unused]] const vec<dual<S>, n_state<Model>>& y) {
    if constexpr (has_delays<Model>) {
        auto p = detail::inputs_along<Model, state_directions<0>, -1, S>(from);
        p.delayed = varied_past<Model, Directions>::template along<-1>(p, from, t, y);
        return p;
    } else {
        return detail::inputs_in<Model>(from);
    }
}
/// The same in all directions at once.
template <class Model, class Directions, class S>
MYRIAD_FUNCTION auto inputs_along_all(const auto& from, [[maybe_unused]] const S& t,
                                      [[maybe_unused]] const vec<moving_number<Directions, S>, n_state<Model>>& y) {
    auto p = detail::inputs_along_all<Model, Directions, S>(from);
    if constexpr (has_delays<Model>) p.delayed = varied_past<Model, Directions>::along_all(p, from, t, y);
    return p;
}

/// The inputs of Model in a hook of a model W that has directions, with the values of the past at the state as it is.
template <class Model, class W, class S>
MYRIAD_FUNCTION inputs<Model, S> inputs_now(const lane<W, S>& l) {
    inputs<Model, S> own = detail::inputs_in<Model>(l);
    if constexpr (has_delays<Model> && !has_constant_lags<Model, double>) {  // the hook may have changed the lags
        inputs<W, S> p;
        p.parameter = l.parameter;
        if constexpr (!accessories_are_outputs<W>) {
            p.accessory = l.accessory;
            p.integer_accessory = l.integer_accessory;
        }
        p.shared = l.shared.values;
        p.shared_integer = l.shared_integer.values;
        p.past = l.past;
        detail::recall<W>(l.t, l.y, p);
        own.delayed = part<n_delayed<Model>>(p.delayed);
    }
    return own;
}

/// Multiplies what is kept of the states from `first` on, and how much later jumps are, by a factor.
template <class Model, class R>
MYRIAD_FUNCTION void scale_past(const past_view<Model, R>& past, int first, R factor) {
    detail::for_each_kept_state<Model>([&](auto place, int state) MYRIAD_LAMBDA {
        if (state < first) return;
        past.initial_of(0)[place * past.stride] *= factor;
        const std::int32_t oldest = past.oldest(0);
        for (std::int32_t k = oldest > 0 ? oldest : 0; k <= past.lane[0].steps; ++k)
            for (int power = 0; power < past.terms; ++power)
                past.terms_of(past.step_of(0, k), place)[power * past.stride] *= factor;
    });
    for (std::int32_t jump = 0; jump < past.slots; ++jump)
        for (int c = 1; c < jump_numbers<Model>; ++c) past.jump_number(0, jump, c) *= factor;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET

namespace myriad::detail {

/// The functions of a model with directions; with delays also what its delayed values are.
template <class Model, class Directions, class Hooks>
struct delayed_variations : forwarded_hooks<Model, Hooks> {};

template <class Model, class Directions, class Hooks>
requires has_delays<Model>
struct delayed_variations<Model, Directions, Hooks> : forwarded_hooks<Model, Hooks> {
    using past = varied_past<Model, Directions>;
    static_assert(
        !has_triggers<Model>,
        "with_tangents and with_sensitivities take no model with delays and triggers: what a trigger does where a "
        "jump of the past makes it fire has no derivatives yet");
    static_assert(!past::times_move || !has_delayed_slopes<Model>,
                  "with_sensitivities, and with_tangents of models with events or with lags by time or state, take no "
                  "model that reads slopes of its past: their derivatives are not there yet");
    static constexpr int n_delayed = past::all;
    static constexpr int n_jump_numbers = 1 + Directions::count;  ///< see breaking_points.hpp

    MYRIAD_FUNCTION static int delayed_state(int j) {
        const int direction = j / past::own, state = Model::delayed_state(j % past::own);
        return direction <= Directions::count ? past::n * direction + state : state;
    }
    /// The lags of all directions are those of Model, so that jumps arrive for all of them at once.
    MYRIAD_FUNCTION static int same_lag(int j) { return first_of_lag<Model>(j % past::own); }
    MYRIAD_FUNCTION static bool is_delayed_slope(int j) {
        return j >= past::first_slope || detail::is_delayed_slope<Model>(j % past::own);
    }
    template <class R>
    MYRIAD_FUNCTION static R lag(int j, const auto& p) requires(has_constant_lags<Model, double>) {
        return Model::template lag<R>(j % past::own, p);
    }
    template <class R>
    MYRIAD_FUNCTION static R lag(int j, const R& t, const auto& y,
                                 const auto& p) requires(!has_constant_lags<Model, double>) {
        return Model::template lag<R>(j % past::own, t, part<past::n>(y), p);
    }

    /// The slopes of Model's own states.
    template <class R>
    MYRIAD_FUNCTION static auto own_slopes(const R& t, const auto& y, const auto& p) {
        return Model::template rhs<R>(t, part<past::n>(y), p);
    }
    /// The quantities that Model observes.
    template <class R>
    MYRIAD_FUNCTION static auto own_quantities(const R& t, const auto& y, const auto& p) {
        return Model::template observe<R>(t, part<past::n>(y), p);
    }
    /// How much later in direction i delayed value k sees a jump that was itself `later`: at (t, y), with the slopes
    /// before it.
    template <int i, class R>
    MYRIAD_FUNCTION static R later_arrival(int k, const R& t, const auto& y, const auto& p,
                                           const vec<R, past::n>& slopes, const R& later) {
        const vec<R, past::n> own = part<past::n>(y);
        const auto moving = detail::inputs_along<Model, Directions, i, R>(p);
        const auto direction = detail::along(own, part<past::n>(y, past::n * (1 + i)));
        const R longer = past::lag(k, dual<R>(t), direction, moving).derivative;
        if constexpr (has_constant_lags<Model, double>) return later + longer;
        const auto still = detail::inputs_along<Model, state_directions<0>, -1, R>(p);
        const R rate = past::lag(k, dual<R>(t, R(1)), detail::along(own, slopes), still).derivative;
        return (later + longer) / (R(1) - rate);
    }
};

template <class Model, class Directions, class Hooks>
struct variations_with_history : delayed_variations<Model, Directions, Hooks> {};

template <class Model, class Directions, class Hooks>
requires has_history<Model>
struct variations_with_history<Model, Directions, Hooks> : delayed_variations<Model, Directions, Hooks> {
    using past = varied_past<Model, Directions>;

    template <class R>
    MYRIAD_FUNCTION static R history(int j, const R& t, const auto& p) {
        const int direction = j / past::own, own = j % past::own;
        R value = R(real_of<R>(0));
        if (direction == 0 || direction > Directions::count) value = Model::template history<R>(own, t, p);
        if constexpr (!is_dual<R>) {
            static_for<0, Directions::count>([&](auto i) MYRIAD_LAMBDA {
                if (direction != 1 + i) return;
                const auto moving = detail::inputs_along<Model, Directions, decltype(i)::value, R>(p);
                value = dual<R>(Model::template history<dual<R>>(own, dual<R>(t), moving)).derivative;
            });
        }
        return value;
    }
    MYRIAD_FUNCTION static bool has_history(int j) {
        if constexpr (requires {
                          { Model::has_history(j) } -> std::same_as<bool>;
                      }) {
            return Model::has_history(j % past::own);
        } else {
            return true;
        }
    }
};

}  // namespace myriad::detail
