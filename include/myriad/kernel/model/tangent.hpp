// SPDX-License-Identifier: MIT
// Tangent dynamics: a model with its variational equations, whose right-hand side is the model's called with dual
// numbers, and with the growth of the tangent vectors, which gives Lyapunov exponents.
#pragma once

#include <utility>

#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/model/tangent_lane.hpp"

namespace myriad::detail {

// One layer for each optional function, present only if the model has it, so that the wrapped model has the same
// functions as the model. Each layer inherits the previous one, and hides the model's function with its own.
namespace tangent_layers {

template <class Model, int vectors>
struct events_layer : Model {};
template <class Model, int vectors>
requires has_events<Model>
struct events_layer<Model, vectors> : Model {
    template <class R>
    MYRIAD_FUNCTION static vec<R, n_event<Model>> events(auto t, const auto& y, const auto& p) {
        return Model::template events<R>(t, part<n_state<Model>>(y), p);
    }
};

template <class Model, int vectors>
struct observe_layer : events_layer<Model, vectors> {};
template <class Model, int vectors>
requires has_observe<Model>
struct observe_layer<Model, vectors> : events_layer<Model, vectors> {
    template <class R>
    MYRIAD_FUNCTION static vec<R, n_observed<Model>> observe(auto t, const auto& y, const auto& p) {
        return Model::template observe<R>(t, part<n_state<Model>>(y), p);
    }
};

template <class Model, int vectors>
struct after_step_layer : observe_layer<Model, vectors> {};
template <class Model, int vectors>
requires(has_after_step<Model> && !has_generic_after_step<Model>) struct after_step_layer<Model, vectors>
    : observe_layer<Model, vectors> {
    MYRIAD_FUNCTION static action after_step(auto& wrapped) {
        action wanted = action::proceed;
        detail::move_tangents<Model, vectors>(wrapped, [&](auto& own) MYRIAD_LAMBDA {
            wanted = detail::action_of([&]() MYRIAD_LAMBDA { return Model::after_step(own); });
        });
        return wanted;
    }
};
template <class Model, int vectors>
requires has_generic_after_step<Model>
struct after_step_layer<Model, vectors> : observe_layer<Model, vectors> {
    template <class R>
    MYRIAD_FUNCTION static mask_of<R> after_step(auto& wrapped) {
        mask_of<R> stops = mask_of<R>(false);
        detail::move_tangents<Model, vectors>(wrapped, [&](auto& own) MYRIAD_LAMBDA {
            if constexpr (std::is_void_v<decltype(Model::template after_step<dual<R>>(own))>) {
                Model::template after_step<dual<R>>(own);
            } else {
                stops = Model::template after_step<dual<R>>(own);
            }
        });
        return stops;
    }
};

/// A neighbouring solution reaches the surface g = 0 later by dt = -(grad g v) / (dg/dt). With f and f+ the slopes
/// before and after the action y -> r(t, y), its distance v becomes Dr (v + f dt) + dr/dt dt - f+ dt (Mueller, Chaos,
/// Solitons and Fractals 5 (1995) 1671), where the first two terms are the derivative of r along (v + f dt, dt).
template <class Model, int vectors>
struct after_event_layer : after_step_layer<Model, vectors> {};
template <class Model, int vectors>
requires has_after_event<Model>
struct after_event_layer<Model, vectors> : after_step_layer<Model, vectors> {
    MYRIAD_FUNCTION static action after_event(int event, auto& wrapped) {
        constexpr int n = n_state<Model>;
        using R = std::remove_cvref_t<decltype(wrapped.t)>;
        const vec<R, n> before = slope<R>(wrapped);
        const R approach = event_along(event, wrapped, before, R(1));
        vec<R, vectors> dt;
        vec<R, vectors * n> arriving;
        MYRIAD_UNROLL
        for (int i = 0; i < vectors; ++i) {
            vec<R, n> v = part<n>(wrapped.y, n + i * n);
            dt[i] = -event_along(event, wrapped, v, R(0)) / approach;
            // If the solution only touches the surface, dt does not exist; this is harmless if nothing jumps.
            const R finite = is_finite(dt[i]) ? dt[i] : R(0);
            for (int c = 0; c < n; ++c) v[c] = fma(before[c], finite, v[c]);
            set_part(arriving, i * n, v);
        }
        action wanted = action::proceed;
        const auto left = detail::move_through<Model, vectors>(wrapped, arriving, dt, [&](auto& own) MYRIAD_LAMBDA {
            wanted = detail::action_of([&]() MYRIAD_LAMBDA { return Model::after_event(event, own); });
        });
        const vec<R, n> after = slope<R>(wrapped);
        const bool no_jump = same_values(left, arriving) && same_values(before, after);
        if (no_jump) return wanted;  // compared exactly, without rounding
        MYRIAD_UNROLL
        for (int i = 0; i < vectors; ++i)
            for (int c = 0; c < n; ++c) wrapped.y[n + i * n + c] = fma(-after[c], dt[i], left[i * n + c]);
        return wanted;
    }

private:
    template <class R>
    MYRIAD_FUNCTION static vec<R, n_state<Model>> slope(const auto& wrapped) {
        return Model::template rhs<R>(wrapped.t, part<n_state<Model>>(wrapped.y), detail::inputs_in<Model>(wrapped));
    }
    template <class R, int n>
    MYRIAD_FUNCTION static R event_along(int event, const auto& wrapped, const vec<R, n>& direction, R dt) {
        const auto g = Model::template events<dual<R>>(dual<R>(wrapped.t, dt), along(part<n>(wrapped.y), direction),
                                                       detail::inputs_in<Model>(wrapped));
        return g[event].derivative;
    }
};

/// Stop times are given, and the same for a neighbouring solution.
template <class Model, int vectors>
struct after_stop_layer : after_event_layer<Model, vectors> {};
template <class Model, int vectors>
requires has_after_stop<Model>
struct after_stop_layer<Model, vectors> : after_event_layer<Model, vectors> {
    MYRIAD_FUNCTION static action after_stop(int stop, int number, auto& wrapped) {
        action wanted = action::proceed;
        detail::move_tangents<Model, vectors>(wrapped, [&](auto& own) MYRIAD_LAMBDA {
            wanted = detail::action_of([&]() MYRIAD_LAMBDA { return Model::after_stop(stop, number, own); });
        });
        return wanted;
    }
};

}  // namespace tangent_layers
}  // namespace myriad::detail

namespace myriad {

/// Model with `vectors` solutions v' = J v of its variational equations, J the Jacobian of its right-hand side: itself
/// a model, in which `with_tangents<Model>::tangent(c, i)` is component c of tangent i among the states. The tangents
/// start orthonormal (`initial_tangents(ensemble)` sets them) and are orthonormalised at the end of every phase by a QR
/// decomposition. The logarithms of the diagonal of R are summed from phase `transient_phases` on: divided by
/// `time_summed`, the sums are the Lyapunov exponents, the largest first (`exponents(ensemble)`); Benettin et al.,
/// Meccanica 15 (1980) 9 and 21. The first components, parameters, shared values, accessories, events and hooks are
/// those of Model; actions transform the tangents like the distance to a neighbouring solution.
///
/// Model's functions, hooks included, are called with dual numbers: their variables must be `auto` or R, the functions
/// they call those of `myriad`. Values that a hook writes outside the state, and `rhs` reads, must not depend on the
/// state, and `rhs` may jump only at an event with `after_event`.
template <class Model, int vectors = 1>
struct with_tangents : detail::tangent_layers::after_stop_layer<Model, vectors> {
    static_assert(detail::check_model<Model>());
    static_assert(!detail::has_triggers<Model>,
                  "with_tangents has no triggers: tangents pass the surface of one event");
    static_assert(vectors >= 1 && vectors <= detail::n_state<Model>,
                  "a model of n components has from 1 to n independent tangent vectors");

    using original = Model;                                    ///< the model without tangents
    static constexpr int n_original = detail::n_state<Model>;  ///< number of its states
    static constexpr int n_vectors = vectors;                  ///< number of tangent vectors

    /// Number of states, the last ones, that are not Model's own.
    static constexpr int n_tangent = vectors * n_original;
    static constexpr int n_state = n_original + n_tangent;  ///< number of all states
    /// Component c of tangent vector i, among the states.
    MYRIAD_FUNCTION static int tangent(int c, int i = 0) { return n_original + i * n_original + c; }

    /// The sum of ln |r_ii| over the phases, among the accessories.
    MYRIAD_FUNCTION static int growth(int i = 0) { return detail::n_accessory<Model> + i; }
    /// The time summed, among the accessories.
    static constexpr int time_summed = detail::n_accessory<Model> + vectors;
    static constexpr int phase_began = time_summed + 1;  ///< the time at which the current phase began
    static constexpr int n_accessory = phase_began + 1;  ///< number of all accessories

    /// Number of phases, from the ensemble's start, left out of the sums, among the shared integers.
    static constexpr int transient_phases = detail::n_shared_integer<Model>;
    static constexpr int n_shared_integer = transient_phases + 1;  ///< number of all shared integers

    /// The slopes of the states and, by dual numbers, of the tangents.
    template <class R>
    MYRIAD_FUNCTION static vec<R, n_state> rhs(auto t, const vec<R, n_state>& y, const auto& p) {
        static_assert(detail::hooks_fit<Model, real_of<R>>);
        return slopes<R>(t, y, p, std::make_integer_sequence<int, n_original>{},
                         std::make_integer_sequence<int, vectors>{}, std::make_integer_sequence<int, n_state>{});
    }

    /// The model's own hook; sets the sums to zero in phase 0.
    MYRIAD_FUNCTION static void initialise(auto& wrapped) {
        const bool at_t_begin = wrapped.t == wrapped.t_begin;
        if constexpr (detail::has_initialise<Model>) {
            const auto given = detail::part<n_tangent>(wrapped.y, n_original);
            detail::move_tangents<Model, vectors>(wrapped, [](auto& own) MYRIAD_LAMBDA { Model::initialise(own); });
            if (wrapped.phase == 0) detail::set_part(wrapped.y, n_original, given);  // they start as given
        }
        wrapped.accessory[phase_began] = at_t_begin ? wrapped.t_begin : wrapped.t;
        if (wrapped.phase == 0) {
            for (int i = 0; i < vectors; ++i) wrapped.accessory[growth(i)] = 0;
            wrapped.accessory[time_summed] = 0;
            detail::orthonormalise<n_original, vectors>(wrapped.y, n_original, [](int, const auto&) MYRIAD_LAMBDA {});
        }
    }

    /// The model's own hook; then orthonormalises the tangents and adds their growth to the sums.
    MYRIAD_FUNCTION static void finalise(auto& wrapped) {
        if constexpr (detail::has_finalise<Model>)
            detail::move_tangents<Model, vectors>(wrapped, [](auto& own) MYRIAD_LAMBDA { Model::finalise(own); });
        const bool counts = wrapped.phase >= wrapped.shared_integer[transient_phases];
        detail::orthonormalise<n_original, vectors>(wrapped.y, n_original,
                                                    [&](int i, const auto& length) MYRIAD_LAMBDA {
                                                        if (counts) wrapped.accessory[growth(i)] += log(length);
                                                    });
        if (counts) wrapped.accessory[time_summed] += wrapped.t - wrapped.accessory[phase_began];
    }

private:
    template <class R, int... c, int... i, int... all>
    MYRIAD_FUNCTION static vec<R, n_state> slopes(const auto& t, const vec<R, n_state>& y, const auto& p,
                                                  std::integer_sequence<int, c...>, std::integer_sequence<int, i...>,
                                                  std::integer_sequence<int, all...>) {
        const auto along_tangent = [&](auto k) MYRIAD_LAMBDA {
            return Model::template rhs<dual<R>>(
                t, vec<dual<R>, n_original>{dual<R>(y[c], y[tangent(c, decltype(k)::value)])...}, p);
        };
        const vec<dual<R>, n_original> f[vectors] = {along_tangent(detail::constant_index<i>{})...};
        return vec<R, n_state>{(all < n_original
                                    ? f[0][all % n_original].value
                                    : f[all / n_original - (all >= n_original)][all % n_original].derivative)...};
    }
};

}  // namespace myriad
