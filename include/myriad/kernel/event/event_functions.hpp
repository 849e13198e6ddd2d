// SPDX-License-Identifier: MIT
// A model's event functions, and their slopes along the solution.
#pragma once

#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/model/lane.hpp"
#include "myriad/kernel/scalar/dual.hpp"
#include "myriad/kernel/scalar/math.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class S>
MYRIAD_FUNCTION vec<S, n_event<Model>> evaluate_events(const S& t, const vec<S, n_state<Model>>& y,
                                                       const inputs<Model, S>& p) {
    return Model::template events<S>(t, y, p);
}

/// Derivatives of the event functions along the solution through (t, y) with the given slope.
template <class Model, class S>
MYRIAD_FUNCTION vec<S, n_event<Model>> event_slopes(const S& t, const vec<S, n_state<Model>>& y,
                                                    const vec<S, n_state<Model>>& slope, const inputs<Model, S>& p) {
    using R = real_of<S>;
    vec<dual<S>, n_state<Model>> y_dual;
    MYRIAD_UNROLL
    for (int c = 0; c < n_state<Model>; ++c) y_dual[c] = dual<S>(y[c], slope[c]);
    const auto g = Model::template events<dual<S>>(dual<S>(t, S(R(1))), y_dual, p);
    vec<S, n_event<Model>> slopes;
    MYRIAD_UNROLL
    for (int j = 0; j < n_event<Model>; ++j) slopes[j] = g[j].derivative;
    return slopes;
}

/// The weight of component c in `event_roundings`: between 1 and 2, no two alike.
template <class R>
MYRIAD_FUNCTION R rounding_weight(int c) {
    const double turns = 0.61803398874989485 * c;
    return static_cast<R>(1 + (turns - static_cast<double>(static_cast<long long>(turns))));
}

/// How far rounding may put the event functions at (t, y) from their values, as far as that shows: nothing can be told
/// from values closer to zero. A few roundings of t and of states of the given sizes, times the derivatives. One
/// derivative does for all of them, with weights, so that x - y has a rounding error though its two terms cancel.
/// States too small for normal numbers have the rounding error of the smallest. Zero where the functions have no finite
/// derivative, or are constant but for jumps.
template <class Model, class R>
MYRIAD_RARE_FUNCTION vec<R, n_event<Model>> event_roundings(R t, vec<R, n_state<Model>> y, vec<R, n_state<Model>> size,
                                                            inputs<Model, R> p) {
    constexpr R least = smallest_normal_of<R> / epsilon_of<R>;
    vec<dual<R>, n_state<Model>> y_dual;
    static_for<0, n_state<Model>>([&](auto c) MYRIAD_LAMBDA {
        if constexpr (team_size<Model> == 1) {
            constexpr R weight = rounding_weight<R>(decltype(c)::value);
            y_dual[c] = dual<R>(y[c], weight * (size[c] + least));
        } else {
            y_dual[c] = dual<R>(y[c], rounding_weight<R>(detail::whole_state<Model>(c)) * (size[c] + least));
        }
    });
    const auto g = Model::template events<dual<R>>(dual<R>(t, R(0.5) * t), y_dual, p);
    vec<R, n_event<Model>> rounding;
    MYRIAD_UNROLL
    for (int j = 0; j < n_event<Model>; ++j) {
        const R change = abs(g[j].derivative);
        rounding[j] = change < infinity_of<R> ? R(8) * epsilon_of<R> * change : R(0);
    }
    return rounding;
}
/// The same for a state that was given, not integrated.
template <class Model, class R>
MYRIAD_FUNCTION vec<R, n_event<Model>> event_roundings(const R& t, const vec<R, n_state<Model>>& y,
                                                       const inputs<Model, R>& p) {
    vec<R, n_state<Model>> size;
    MYRIAD_UNROLL
    for (int c = 0; c < n_state<Model>; ++c) size[c] = abs(y[c]);
    return detail::event_roundings<Model>(t, y, size, p);
}

/// The signs that event functions show first after (t, y) on the parabola with this slope and second derivative, in the
/// direction of h: where they and their changes exceed their rounding errors, from the time `first`, but at least its
/// resolution, to a 64th of t and h. Zero where none does. For functions whose own slope is zero and says nothing, as
/// that of x^3 at x = 0.
template <class Model, class R>
MYRIAD_RARE_FUNCTION vec<R, n_event<Model>> first_signs(R t, vec<R, n_state<Model>> y, vec<R, n_state<Model>> slope,
                                                        vec<R, n_state<Model>> bend, R first, R h, inputs<Model, R> p) {
    const auto here = detail::evaluate_events<Model>(t, y, p);
    vec<R, n_event<Model>> sign{};
    const R size = abs(t) + abs(h);
    MYRIAD_ROLLED
    for (R ahead = max(R(64) * epsilon_of<R> * size, first); ahead * R(64) <= size; ahead *= R(16)) {
        const R length = copysign(ahead, h);
        vec<R, n_state<Model>> there;
        MYRIAD_UNROLL
        for (int c = 0; c < n_state<Model>; ++c) there[c] = fma(length, fma(R(0.5) * length, bend[c], slope[c]), y[c]);
        const auto g = detail::evaluate_events<Model>(t + length, there, p);
        const auto rounding = detail::event_roundings<Model>(t + length, there, p);
        bool all = true;
        MYRIAD_UNROLL
        for (int j = 0; j < n_event<Model>; ++j) {
            const bool shows = abs(g[j]) > rounding[j] && abs(g[j] - here[j]) > rounding[j];
            if (sign[j] == R(0) && shows) sign[j] = g[j] > R(0) ? R(1) : R(-1);
            all = all && sign[j] != R(0);
        }
        if (all) break;
    }
    return sign;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
