// SPDX-License-Identifier: MIT
// Event functions on noisy paths between the ends of a step. With the noise as at its start, a function is a Brownian
// motion there, and, its values at both ends given, a Brownian bridge: whether it has been at zero in between, and when
// for the first time, have known laws.
#pragma once

#include <cstdint>

#include "myriad/kernel/event/event_functions.hpp"
#include "myriad/kernel/model/noise.hpp"
#include "myriad/kernel/model/random.hpp"
#include "myriad/kernel/model/wiener_path.hpp"
#include "myriad/kernel/scalar/dual.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// What the numbers are for that a step draws beside its increments. They have the counters of a path at the beginning
/// of the step, and other keys.
enum class bridge_draw : std::uint32_t {
    crossing,  // whether a function has been at zero
    passage,   // when
    aside,     // the processes then, but for what has brought the function there
    extreme,   // the extreme of a quantity of summaries
    when,      // its time
};

/// Normal numbers of a step for one of these, of the number-th group: as many as a block has.
template <class S>
MYRIAD_CALLED_FUNCTION group_increments<S> bridge_normals(MYRIAD_CALL_ARGUMENT(path_interval<S>) over,
                                                          MYRIAD_CALL_ARGUMENT(bridge_draw) what,
                                                          MYRIAD_CALL_ARGUMENT(int) number) {
    constexpr int groups = 256;  // a group has 8 bits in a counter
    const auto others = static_cast<std::uint32_t>(what) << 24 | static_cast<std::uint32_t>(number / groups);
    const auto& key = over.constants->keys.of_round[0];
    return detail::path_normals<S>(over.from.cell, over.from.part, over.of, {key[0] ^ 0x6a09e667u, key[1] + others},
                                   number % groups);
}

/// The largest sum of squares of two normal numbers from one block.
template <class R>
inline constexpr double most_squares = sizeof(R) == sizeof(double) ? 74 : 45;

/// Whether a bridge from g0 to g1 of this variance, both on one side of zero, has been at zero: with probability
/// exp(-2 g0 g1 / variance). The sum of squares of two normal numbers is -2 log U of a uniform one. Always if the ends
/// are on different sides.
template <class S>
MYRIAD_FUNCTION mask_of<S> bridge_crosses(const S& g0, const S& g1, const S& variance, const S& squares) {
    const S product = g0 * g1;
    return (squares * variance > S(real_of<S>(4)) * product) | (product <= S(real_of<S>(0)));
}

/// When such a bridge is at zero first, as a part of its length, by a normal number and another one: z = theta / (1 -
/// theta) has the inverse Gaussian distribution of mean |g0 / g1| and shape g0^2 / variance, whichever side g1 is on,
/// since the path may be reflected from there on. Sampled by Michael, Schucany and Haas, Amer. Statist. 30 (1976)
/// 88-90; the smaller root without cancellation, for variances of zero too, where it is |g0| / (|g0| + |g1|).
template <class R>
MYRIAD_FUNCTION R first_passage(R g0, R g1, R variance, R normal, R other) {
    const R a = abs(g0), b = abs(g1);
    const R q = R(0.5) * variance * normal * normal / a;
    const R rest = b + q + sqrt(q * (R(2) * b + q));  // the smaller root is a / rest
    const R theta = a / (a + rest);
    const R likely = rest / (rest + b);  // the probability of the smaller one
    if (!(other > normal_quantile(likely))) return theta;
    return a * rest / (a * rest + b * b);
}

/// The states on which event functions depend, as far as that can be found.
template <class Model>
struct states_of_events {
    bool read[n_state<Model>] = {};
};
template <class Model>
constexpr states_of_events<Model> trace_events() {
    constexpr int n = n_state<Model>;
    using S = dependence<n + 1>;
    const traced_inputs<Model, S> traced;
    const inputs<Model, S>& p = traced;
    vec<S, n> y;
    for (int i = 0; i < n; ++i) y[i] = S::of(i);
    const vec<S, n_event<Model>> g = Model::template events<S>(S::of(n), y, p);
    states_of_events<Model> found;
    for (int j = 0; j < n_event<Model>; ++j)
        for (int c = 0; c < n; ++c) found.read[c] = found.read[c] || g[j].contains(c);
    return found;
}
template <class Model>
constexpr states_of_events<Model> states_of_events_in() {
    if constexpr (!scalar_only<Model> && n_state<Model> <= largest_traced_system) {
        if constexpr (requires { typename std::bool_constant<(trace_events<Model>(), true)>; })
            return trace_events<Model>();
    }
    states_of_events<Model> all;
    for (bool& read : all.read) read = true;
    return all;
}
template <class Model>
inline constexpr states_of_events<Model> traced_events = states_of_events_in<Model>();

/// The square of a derivative along the noise; NaN if it is too small for a square.
template <class S>
MYRIAD_FUNCTION S square_along_noise(const S& d) {
    constexpr auto least = smallest_normal_of<S> * real_of<S>(0x1p24);
    const S square = d * d;
    return select((d != S(real_of<S>(0))) & (square < S(least)), S(nan_of<S>), square);
}

/// The event functions at a point, and how the noise moves them there.
template <class Model, class S>
struct moved_events {
    vec<S, n_event<Model>> g;
    vec<S, n_event<Model>> rate;  // their variances per time
};

/// The state with its derivative in the direction of process k.
template <class Model, class S>
MYRIAD_FUNCTION vec<dual<S>, n_state<Model>> moved_by_process(const vec<S, n_state<Model>>& y,
                                                              const diffusion_type<Model, S>& factors, int k) {
    vec<dual<S>, n_state<Model>> moving;
    MYRIAD_UNROLL_UP_TO(64, 16)
    for (int c = 0; c < MYRIAD_LENGTH(n_state<Model>); ++c) {
        if constexpr (has_general_noise<Model>) {
            moving[c] = dual<S>(y[c], factors[c][k]);
        } else {
            moving[c] = dual<S>(y[c], c == k ? factors[c] : S(real_of<S>(0)));
        }
    }
    return moving;
}
/// The event functions with their derivatives in the direction of process k.
template <class Model, class S>
MYRIAD_FUNCTION vec<dual<S>, n_event<Model>> events_along(const S& t, const vec<S, n_state<Model>>& y,
                                                          const inputs<Model, S>& p,
                                                          const diffusion_type<Model, S>& factors, int k) {
    return detail::evaluate_moving_events<Model>(dual<S>(t), detail::moved_by_process<Model>(y, factors, k), p);
}

template <class Model, class S>
MYRIAD_FUNCTION moved_events<Model, S> events_with_noise(const S& t, const vec<S, n_state<Model>>& y,
                                                         const inputs<Model, S>& p) {
    const diffusion_type<Model, S> factors = Model::template diffusion<S>(t, y, p);
    moved_events<Model, S> found;
    found.g = detail::evaluate_events<Model>(t, y, p);
    MYRIAD_UNROLL
    for (int j = 0; j < MYRIAD_LENGTH(n_event<Model>); ++j) found.rate[j] = S(real_of<S>(0));
    const auto add = [&](int k) MYRIAD_LAMBDA {
        const auto along = detail::events_along<Model>(t, y, p, factors, k);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(n_event<Model>); ++j)
            found.rate[j] = found.rate[j] + detail::square_along_noise(along[j].derivative);
    };
    if constexpr (has_general_noise<Model>) {
        MYRIAD_UNROLL_UP_TO(16, 4)
        for (int k = 0; k < MYRIAD_LENGTH(n_wiener<Model>); ++k) add(k);
    } else if constexpr (n_state<Model> <= MYRIAD_MOST_COPIES) {
        static_for<0, n_state<Model>>([&](auto k) MYRIAD_LAMBDA {
            if constexpr (traced_events<Model>.read[decltype(k)::value]) add(k);
        });
    } else {
        for (int k = 0; k < MYRIAD_LENGTH(n_state<Model>); ++k) add(k);
    }
    return found;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
