// SPDX-License-Identifier: MIT
// A model's event functions, and their slopes along the solution.
#pragma once

#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/model/jacobian_pattern.hpp"
#include "myriad/kernel/model/lane.hpp"
#include "myriad/kernel/model/recall.hpp"
#include "myriad/kernel/scalar/dual.hpp"
#include "myriad/kernel/scalar/math.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class S>
MYRIAD_FUNCTION vec<S, n_event<Model>> evaluate_events(const S& t, const vec<S, n_state<Model>>& y,
                                                       const inputs<Model, S>& p) {
    if constexpr (has_delays<Model>) detail::recall<Model>(t, y, p);
    return Model::template events<S>(t, y, p);
}

/// The same with derivatives in some direction.
template <class Model, class S>
MYRIAD_FUNCTION auto evaluate_moving_events(const dual<S>& t, const vec<dual<S>, n_state<Model>>& y,
                                            const inputs<Model, S>& p) {
    if constexpr (has_delays<Model>) {
        return Model::template events<dual<S>>(t, y, detail::moving_past<Model>(t, y, p));
    } else {
        return Model::template events<dual<S>>(t, y, p);
    }
}

/// Derivatives of the event functions along the solution through (t, y) with the given slope.
template <class Model, class S>
MYRIAD_FUNCTION vec<S, n_event<Model>> event_slopes(const S& t, const vec<S, n_state<Model>>& y,
                                                    const vec<S, n_state<Model>>& slope, const inputs<Model, S>& p) {
    using R = real_of<S>;
    vec<dual<S>, n_state<Model>> y_dual;
    MYRIAD_UNROLL
    for (int c = 0; c < MYRIAD_LENGTH(n_state<Model>); ++c) y_dual[c] = dual<S>(y[c], slope[c]);
    const auto g = detail::evaluate_moving_events<Model>(dual<S>(t, S(R(1))), y_dual, p);
    vec<S, n_event<Model>> slopes;
    MYRIAD_UNROLL
    for (int j = 0; j < MYRIAD_LENGTH(n_event<Model>); ++j) slopes[j] = g[j].derivative;
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
/// That of a denormal state is two to four thousand of the smallest numbers, as each stage of a step rounds: what
/// decays until it is zero has not crossed it. Zero where the functions have no finite derivative, or are constant but
/// for jumps.
template <class Model, class R>
MYRIAD_FUNCTION vec<R, n_event<Model>> compute_roundings(const R& t, const vec<R, n_state<Model>>& y,
                                                         const vec<R, n_state<Model>>& size,
                                                         const inputs<Model, R>& p) {
    constexpr R least = R(256) * smallest_normal_of<R>;
    vec<dual<R>, n_state<Model>> y_dual;
    if constexpr (n_state < Model >> largest_traced_system) {
        for (int c = 0; c < MYRIAD_LENGTH(n_state<Model>); ++c)
            y_dual[c] = dual<R>(y[c], rounding_weight<R>(detail::whole_state<Model>(c)) * (size[c] + least));
    } else {
        static_for<0, n_state<Model>>([&](auto c) MYRIAD_LAMBDA {
            if constexpr (team_size<Model> == 1) {
                constexpr R weight = rounding_weight<R>(decltype(c)::value);
                y_dual[c] = dual<R>(y[c], weight * (size[c] + least));
            } else {
                y_dual[c] = dual<R>(y[c], rounding_weight<R>(detail::whole_state<Model>(c)) * (size[c] + least));
            }
        });
    }
    const auto g = detail::evaluate_moving_events<Model>(dual<R>(t, R(0.5) * t), y_dual, p);
    vec<R, n_event<Model>> rounding;
    MYRIAD_UNROLL
    for (int j = 0; j < MYRIAD_LENGTH(n_event<Model>); ++j) {
        const R change = abs(g[j].derivative);
        rounding[j] = change < infinity_of<R> ? R(8) * epsilon_of<R> * change : R(0);
    }
    return rounding;
}

/// What the functions below, which are rarely called, work on. It lies in memory: as arguments or in registers, it
/// would take registers of the whole loop.
template <class Model, class R>
struct event_place {
    using state = vec<R, n_state<Model>>;
    using reals = vec<R, n_event<Model>>;

    inputs<Model, R> p;
    R t;
    state y, size;
    // a path from there, in the direction of h, with this slope and second derivative, looked at from the time `first`
    R h, first;
    state slope, bend;
    // and a point of it
    R length;
    state there;
    reals here, rounding, sign;
};

/// `compute_roundings` out of line.
template <class Model, class R>
MYRIAD_RARE_FUNCTION void find_roundings(event_place<Model, R>* at) {
    at->rounding = detail::compute_roundings<Model>(at->t, at->y, at->size, at->p);
}
template <class Model, class R>
MYRIAD_FUNCTION vec<R, n_event<Model>> event_roundings(const R& t, const vec<R, n_state<Model>>& y,
                                                       const vec<R, n_state<Model>>& size, const inputs<Model, R>& p,
                                                       event_place<Model, R>* place) {
    place->p = p;
    place->t = t;
    place->y = y;
    place->size = size;
    detail::find_roundings(place);
    return place->rounding;
}
/// The same for a state that was given, not integrated.
template <class Model, class R>
MYRIAD_FUNCTION vec<R, n_event<Model>> event_roundings(const R& t, const vec<R, n_state<Model>>& y,
                                                       const inputs<Model, R>& p, event_place<Model, R>* place) {
    vec<R, n_state<Model>> size;
    MYRIAD_UNROLL
    for (int c = 0; c < MYRIAD_LENGTH(n_state<Model>); ++c) size[c] = abs(y[c]);
    return detail::event_roundings<Model>(t, y, size, p, place);
}

/// Whether a slope tells where a function goes.
template <class R>
MYRIAD_FUNCTION bool tells_heading(R slope) {
    return abs(slope) > R(0) && abs(slope) < infinity_of<R>;
}

/// Finds the signs that event functions show first on a path: where they and their changes exceed their rounding
/// errors, from the time `first`, but at least its resolution, to a 64th of t and h. Zero where none does. For
/// functions whose own slope is zero and says nothing, as that of x^3 at x = 0.
template <class Model, class R>
MYRIAD_RARE_FUNCTION void find_first_signs(event_place<Model, R>* path) {
    constexpr auto n = n_state<Model>, m = n_event<Model>;
    path->here = detail::evaluate_events<Model>(path->t, path->y, path->p);
    MYRIAD_UNROLL
    for (int j = 0; j < MYRIAD_LENGTH(m); ++j) path->sign[j] = R(0);
    const R least = max(R(64) * epsilon_of<R> * (abs(path->t) + abs(path->h)), R(smallest_normal_of<R>));
    path->length = copysign(max(least, path->first), path->h);
    // The bound is finite, so that the search ends.
    MYRIAD_ROLLED
    while (abs(path->length) <= R(1.0 / 64) * abs(path->t) + R(1.0 / 64) * abs(path->h)) {
        MYRIAD_OPTIMISATION_BARRIER(path);  // else what it points to occupies registers throughout
        const R length = path->length;
        MYRIAD_UNROLL
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c) {
            path->there[c] = fma(length, fma(R(0.5) * length, path->bend[c], path->slope[c]), path->y[c]);
            path->size[c] = abs(path->there[c]);
        }
        path->rounding = detail::compute_roundings<Model>(path->t + length, path->there, path->size, path->p);
        MYRIAD_OPTIMISATION_BARRIER(path);
        const auto g = detail::evaluate_events<Model>(path->t + path->length, path->there, path->p);
        bool all = true;
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            const R rounding = path->rounding[j];
            const bool shows = abs(g[j]) > rounding && abs(g[j] - path->here[j]) > rounding;
            if (path->sign[j] == R(0) && shows) path->sign[j] = g[j] > R(0) ? R(1) : R(-1);
            all = all && path->sign[j] != R(0);
        }
        if (all) break;
        path->length *= R(16);
    }
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
