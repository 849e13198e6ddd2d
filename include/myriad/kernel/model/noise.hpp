// SPDX-License-Identifier: MIT
// The noise of a model: the shape of its diffusion, and what that depends on, found when it is compiled.
#pragma once

#include <type_traits>

#include "myriad/kernel/methods/stochastic_method.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/model/jacobian_pattern.hpp"
#include "myriad/kernel/model/lane.hpp"
#include "myriad/kernel/model/summaries.hpp"
#include "myriad/kernel/scalar/dependence.hpp"
#include "myriad/kernel/scalar/normal_numbers.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Whether the Wiener processes of a model are numbered by `enum noise`, and its diffusion is a matrix. Else it is
/// diagonal: each state has a process of its own.
template <class Model>
inline constexpr bool has_general_noise = has_diffusion<Model>&& n_noise<Model> != 0;

template <class Model>
constexpr extent n_wiener_of() {
    if constexpr (!has_diffusion<Model>) {
        return 0;
    } else if constexpr (has_general_noise<Model>) {
        return n_noise<Model>;
    } else {
        return n_state<Model>;
    }
}
/// Number of Wiener processes.
template <class Model>
inline constexpr extent n_wiener = n_wiener_of<Model>();

/// What `diffusion` returns: a number for each state, or a row for each state of numbers for each process.
template <class Model, class S>
using diffusion_type =
    std::conditional_t<has_general_noise<Model>, vec<vec<S, n_noise<Model>>, n_state<Model>>, vec<S, n_state<Model>>>;

/// What a diffusion depends on.
struct noise_dependence {
    bool on_states;        ///< on any state
    bool on_other_states;  ///< the factor of a state on another one; of a matrix the same as `on_states`
};

/// A diffusion is evaluated for what it depends on, as a right-hand side for the Jacobian's pattern.
template <class Model>
constexpr noise_dependence trace_noise() {
    constexpr int n = n_state<Model>;
    using S = dependence<n + 1>;
    const traced_inputs<Model, S> traced;
    const inputs<Model, S>& p = traced;
    vec<S, n> y;
    for (int i = 0; i < n; ++i) y[i] = S::of(i);
    const diffusion_type<Model, S> g = Model::template diffusion<S>(S::of(n), y, p);
    noise_dependence found{};
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            if constexpr (has_general_noise<Model>) {
                for (int k = 0; k < n_noise<Model>; ++k) found.on_states = found.on_states || g[i][k].contains(j);
                found.on_other_states = found.on_states;
            } else {
                found.on_states = found.on_states || g[i].contains(j);
                found.on_other_states = found.on_other_states || (i != j && g[i].contains(j));
            }
        }
    return found;
}

template <class Model>
constexpr noise_dependence dependence_of_noise_of() {
    if constexpr (team_size<Model> != 1) {
        return dependence_of_noise_of<whole_of<Model>>();
    } else if constexpr (!scalar_only<Model> && n_state<Model> <= largest_traced_system) {
        if constexpr (requires { typename std::bool_constant<(trace_noise<Model>(), true)>; })
            return trace_noise<Model>();
    }
    return {true, has_general_noise<Model>};
}
/// What a model's diffusion depends on. Where it cannot be evaluated without values, as it branches or reads integers,
/// it counts as one that depends on the state, and, if diagonal, on each one's own.
template <class Model>
inline constexpr noise_dependence dependence_of_noise = dependence_of_noise_of<Model>();

/// Whether the diffusion does not depend on the state: as declared, or found.
template <class Model>
inline constexpr bool is_additive = additive_noise<whole_of<Model>> || !dependence_of_noise<Model>.on_states;

/// The most Wiener processes that the counters of a path have room for.
template <class R>
inline constexpr int most_processes = groups_of_increments* normals_per_block<R>;

/// Refuses a stochastic equation with a method for ordinary ones and the reverse, and what is not there for noise.
template <class Model, class Method, class R>
constexpr bool check_noise() {
    if constexpr (!has_diffusion<Model>) {
        static_assert(!stochastic_method<Method>,
                      "this method integrates stochastic equations, but the model has no diffusion: give it `template "
                      "<class R> MYRIAD_FUNCTION static myriad::vec<R, n_state> diffusion(auto t, const myriad::vec<R, "
                      "n_state>& y, const auto& p)`, or use a method for ordinary equations");
    } else {
        static_assert(stochastic_method<Method>,
                      "the model has a diffusion, which methods for ordinary equations would ignore: use "
                      "euler_maruyama, or another method for noise");
        static_assert(n_wiener<whole_of<Model>> <= most_processes<R>,
                      "the model has more than 256 Wiener processes, or 512 in single precision: more than the "
                      "counters of a path have room for");
        static_assert(!has_triggers<Model>,
                      "a model with a diffusion has no triggers yet: its paths are too rough for conditions that come "
                      "to hold; give it events, or look for a condition at the ends of steps, in after_step");
        static_assert(!writes_time_domain<Model>,
                      "a model with a diffusion may not declare writes_time_domain: its paths count time from t_begin");
        static_assert(
            !summarises_any<Model, over_phase::integral>,
            "a model with a diffusion has no integrals over a phase yet: give an integral a state of its own");
        static_assert(!has_summaries<Model> || !has_events<Model>,
                      "a model with a diffusion has no extrema over a phase beside events yet: an event and an extreme "
                      "would not know of each other within a step; take extrema in after_step");
        if constexpr (stochastic_method<Method>) {
            static_assert((!has_events<Model> && !has_summaries<Model>) || Method::strong_order != 0,
                          "this method follows no path, so that between the ends of a step there is nothing for an "
                          "event or an extreme to be found on: use euler_maruyama, or another method with a strong "
                          "order");
            static_assert(
                (!has_events<Model> && !has_summaries<Model>) || !uses_jacobian<Method>,
                "this method is for steps in which a stiff drift undoes the noise, and events and extrema are "
                "found within steps as if it did not: use euler_maruyama with steps that resolve the drift");
            static_assert((!has_events<Model> && !has_summaries<Model>) || Method::embedded_order == 0,
                          "events and extrema of a model with a diffusion are found only in fixed steps: use the "
                          "method without `adaptive`, and give options::step");
            if constexpr (Method::noise == noise_taken::additive)
                static_assert(
                    is_additive<Model>,
                    "this method takes additive noise alone, but the diffusion may depend on the state: use "
                    "another method, or declare `static constexpr bool additive_noise = true;` if it does not");
            if constexpr (Method::noise == noise_taken::diagonal) {
                static_assert(is_additive<Model> || !has_general_noise<Model>,
                              "this method takes diagonal or additive noise alone, but the model has an `enum noise`, "
                              "whose processes states may share: use euler_maruyama, or stochastic_heun for the "
                              "Stratonovich equation");
                static_assert(
                    is_additive<Model> || has_general_noise<Model> || !dependence_of_noise<Model>.on_other_states,
                    "this method takes noise whose factor of a state depends on no other state: use "
                    "euler_maruyama, or stochastic_heun for the Stratonovich equation");
            }
        }
    }
    return true;
}
template <class Model, class Method, class R>
inline constexpr bool noise_fits = check_noise<Model, Method, R>();

}  // namespace myriad::detail::inline MYRIAD_TARGET
