// SPDX-License-Identifier: MIT
// A model together with neighbouring solutions, in directions that are states after its own: the variational equations
// by dual numbers, and how hooks, events and stop times transform the directions. What the directions are is
// `Directions`, as in tangent_lane.hpp.
#pragma once

#include <utility>

#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/model/moving_summaries.hpp"
#include "myriad/kernel/model/varied_past.hpp"
#include "myriad/kernel/scalar/lanes.hpp"

namespace myriad::detail {

/// A neighbouring solution reaches the surface g = 0 later by dt = -(grad g v) / (dg/dt). With f and f+ the slopes
/// before and after the action y -> r(t, y), its distance v becomes Dr (v + f dt) + dr/dt dt - f+ dt (Mueller, Chaos,
/// Solitons and Fractals 5 (1995) 1671), where the first two terms are the derivative of r along (v + f dt, dt).
template <class Model, class Directions>
struct crossing {
    static constexpr int n = n_state<Model>, count = Directions::count;
    static constexpr bool moves_summaries = has_summaries<Model> && Directions::keeps_times;

    template <class R>
    MYRIAD_FUNCTION static vec<R, n> slope(const auto& wrapped) {
        return Model::template rhs<R>(wrapped.t, part<n>(wrapped.y), detail::inputs_now<Model>(wrapped));
    }

    /// How much later neighbouring solutions reach the surface of an event.
    template <class R>
    MYRIAD_FUNCTION static vec<R, count> delays(int event, const auto& wrapped) {
        const auto derivative = [&](const vec<R, n>& direction, R dt, const auto& inputs_at) MYRIAD_LAMBDA {
            const dual<R> t(wrapped.t, dt);
            const vec<dual<R>, n> y = along(part<n>(wrapped.y), direction);
            return Model::template events<dual<R>>(t, y, inputs_at(t, y))[event].derivative;
        };
        const R approach = derivative(slope<R>(wrapped), R(1), [&](const auto& t, const auto& y) MYRIAD_LAMBDA {
            return detail::inputs_along_solution<Model, Directions, R>(wrapped, t, y);
        });
        vec<R, count> dt;
        static_for<0, count>([&](auto i) MYRIAD_LAMBDA {
            const auto inputs_at = [&](const auto& t, const auto& y) MYRIAD_LAMBDA {
                return detail::inputs_along<Model, Directions, i.value, R>(wrapped, t, y);
            };
            dt[i] = -derivative(part<n>(wrapped.y, n + i * n), R(0), inputs_at) / approach;
        });
        return dt;
    }

    /// Calls an action of the model's at a time that is later by dt in neighbouring solutions. A dt that is not finite
    /// does not exist, as where the solution only touches a surface; this is harmless if nothing jumps. Returns false
    /// if something does.
    template <class R>
    MYRIAD_FUNCTION static bool cross(auto& wrapped, const vec<R, count>& dt, auto&& hook) {
        const vec<R, n> before = slope<R>(wrapped);
        vec<R, count * n> arriving;
        vec<R, count> finite;
        MYRIAD_UNROLL
        for (int i = 0; i < count; ++i) {
            vec<R, n> v = part<n>(wrapped.y, n + i * n);
            finite[i] = is_finite(dt[i]) ? dt[i] : R(0);
            for (int c = 0; c < n; ++c) v[c] = fma(before[c], finite[i], v[c]);
            set_part(arriving, i * n, v);
        }
        using summaries = moving_summaries<Model, Directions>;
        if constexpr (moves_summaries) summaries::arrive(wrapped, arriving, finite);
        const auto left = detail::move_through<Model, Directions>(wrapped, arriving, dt, hook);
        const vec<R, n> after = slope<R>(wrapped);
        if constexpr (moves_summaries) summaries::extend(wrapped, finite, R(-1));
        if (same_values(left, arriving) && same_values(before, after)) return true;  // exactly, without rounding
        if constexpr (has_delays<Model>) note_jump(wrapped, dt);
        if constexpr (moves_summaries) summaries::lose(wrapped, dt);
        MYRIAD_UNROLL
        for (int i = 0; i < count; ++i)
            for (int c = 0; c < n; ++c) wrapped.y[n + i * n + c] = fma(-after[c], dt[i], left[i * n + c]);
        return all_finite(dt);
    }

private:
    /// For `breaking_points`: how much later the jump is. Of two at one instant that move differently none is known.
    template <class R>
    MYRIAD_FUNCTION static void note_jump(auto& wrapped, const vec<R, count>& dt) {
        for (int i = 0; i < count; ++i) {
            R& later = wrapped.later[1 + i];
            later = wrapped.later[0] != R(0) && later != dt[i] ? nan_of<R> : dt[i];
        }
        wrapped.later[0] = R(1);
    }
};

/// How the functions of a model act on the model and its directions. See `forwarded_hooks`.
template <class Model, class Directions>
struct varied_hooks {
    static constexpr bool after_step_is_generic = has_generic_after_step<Model>,
                          acts_at_all_events = has_events<Model> && Directions::keeps_times;

    template <class R>
    MYRIAD_FUNCTION static vec<R, n_event<Model>> events(auto t, const auto& y, const auto& p) {
        return Model::template events<R>(t, part<n_state<Model>>(y), p);
    }
    template <class R>
    MYRIAD_FUNCTION static vec<R, n_observed<Model>> observe(auto t, const auto& y, const auto& p) {
        return Model::template observe<R>(t, part<n_state<Model>>(y), p);
    }

    MYRIAD_FUNCTION static void initialise(auto& wrapped) {
        detail::move_directions<Model, Directions>(wrapped, [](auto& own) MYRIAD_LAMBDA { Model::initialise(own); });
    }
    MYRIAD_FUNCTION static action after_step(auto& wrapped) {
        action wanted = action::proceed;
        detail::move_directions<Model, Directions>(
            wrapped, acting(wanted, [](auto& own) MYRIAD_LAMBDA { return Model::after_step(own); }));
        return wanted;
    }
    template <class R>
    MYRIAD_FUNCTION static mask_of<R> after_step(auto& wrapped) {
        mask_of<R> stops = mask_of<R>(false);
        detail::move_directions<Model, Directions>(wrapped, [&](auto& own) MYRIAD_LAMBDA {
            if constexpr (std::is_void_v<decltype(Model::template after_step<dual<R>>(own))>) {
                Model::template after_step<dual<R>>(own);
            } else {
                stops = Model::template after_step<dual<R>>(own);
            }
        });
        return stops;
    }
    MYRIAD_FUNCTION static action after_event(int event, auto& wrapped) {
        using R = std::remove_cvref_t<decltype(wrapped.t)>;
        const auto dt = crossing<Model, Directions>::template delays<R>(event, wrapped);
        action wanted = action::proceed;
        const auto act = [&](auto& own) MYRIAD_LAMBDA {
            if constexpr (has_after_event<Model>)
                wanted = detail::action_of([&]() MYRIAD_LAMBDA { return Model::after_event(event, own); });
        };
        cross<R>(wrapped, dt, act);
        return wanted;
    }
    /// A trigger fires where neighbouring solutions reach the surface of the function that has made its condition hold,
    /// or at the time of the action that has.
    MYRIAD_FUNCTION static action after_trigger_by(int function, int trigger, auto& wrapped) {
        static_assert(Directions::keeps_times, "models with triggers have no tangents");
        using R = std::remove_cvref_t<decltype(wrapped.t)>;
        const vec<R, Directions::count> dt = function >= 0
                                                 ? crossing<Model, Directions>::template delays<R>(function, wrapped)
                                                 : Directions::template delays_of_action<R>(wrapped);
        action wanted = action::proceed;
        cross<R>(wrapped, dt,
                 acting(wanted, [&](auto& own) MYRIAD_LAMBDA { return Model::after_trigger(trigger, own); }));
        return wanted;
    }
    /// Stop times of a neighbouring solution are the same, unless they depend on inputs that differ.
    MYRIAD_FUNCTION static action after_stop(int stop, int number, auto& wrapped) {
        action wanted = action::proceed;
        const auto act = acting(wanted, [&](auto& own) MYRIAD_LAMBDA { return Model::after_stop(stop, number, own); });
        if constexpr (Directions::keeps_times) {
            using R = std::remove_cvref_t<decltype(wrapped.t)>;
            vec<R, Directions::count> dt;
            static_for<0, Directions::count>([&](auto i) MYRIAD_LAMBDA {
                dt[i] = dual<R>(Model::template stop_time<dual<R>>(
                                    stop, number, detail::inputs_along<Model, Directions, i.value, R>(wrapped)))
                            .derivative;
            });
            cross<R>(wrapped, dt, act);
        } else {
            detail::move_directions<Model, Directions>(wrapped, act);
        }
        return wanted;
    }
    MYRIAD_FUNCTION static void finalise(auto& wrapped) {
        detail::move_directions<Model, Directions>(wrapped, [](auto& own) MYRIAD_LAMBDA { Model::finalise(own); });
    }

private:
    /// Calls a hook of the model and keeps the action that it wants.
    template <class Hook>
    MYRIAD_FUNCTION static auto acting(action& wanted, Hook hook) {
        return [&wanted, hook](auto& own)
                   MYRIAD_LAMBDA { wanted = detail::action_of([&]() MYRIAD_LAMBDA { return hook(own); }); };
    }
    /// Calls an action at a time that is later by dt in neighbouring solutions.
    template <class R>
    MYRIAD_FUNCTION static void cross(auto& wrapped, const vec<R, Directions::count>& dt, auto&& act) {
        const auto crossed = [&]() MYRIAD_LAMBDA {
            return crossing<Model, Directions>::template cross<R>(wrapped, dt, act);
        };
        if constexpr (Directions::keeps_times) {
            Directions::cross_at_event(wrapped, dt, crossed);
        } else {
            crossed();
        }
    }
};

/// Model with `Directions::count` directions v' = J v + df/dp, among the states after Model's own: v of direction i
/// begins at n (1 + i).
template <class Model, class Directions>
struct with_variations : variations_with_history<Model, Directions, varied_hooks<Model, Directions>> {
    static_assert(check_model<Model>());
    static_assert(!has_diffusion<Model>,
                  "with_tangents and with_sensitivities take no model with a diffusion: derivatives of its paths are "
                  "not there yet");

    using original = Model;                                    ///< the model alone
    static constexpr int n_original = detail::n_state<Model>;  ///< number of its states
    /// Number of states, the last ones, that are not Model's own.
    static constexpr int n_tangent = Directions::count * n_original;
    static constexpr int n_state = n_original + n_tangent;  ///< number of all states

    /// The slopes of the states and, by dual numbers, of the directions.
    template <class R>
    MYRIAD_FUNCTION static vec<R, n_state> rhs(auto t, const vec<R, n_state>& y, const auto& p) {
        static_assert(hooks_fit<Model, real_of<R>>);
        return slopes<R>(t, y, p, std::make_integer_sequence<int, n_original>{},
                         std::make_integer_sequence<int, Directions::count>{},
                         std::make_integer_sequence<int, n_state>{});
    }

private:
    template <class R, int... c, int... i, int... all>
    MYRIAD_FUNCTION static vec<R, n_state> slopes(const auto& t, const vec<R, n_state>& y, const auto& p,
                                                  std::integer_sequence<int, c...>, std::integer_sequence<int, i...>,
                                                  std::integer_sequence<int, all...>) {
        if constexpr (Directions::carries_accessories) {  // all at once, as most inputs move in none or one of them
            using number = moving_number<Directions, R>;
            const auto moving = [&](auto k) MYRIAD_LAMBDA {
                return number(y[k], partials<R, Directions::count>::each(
                                        [&](auto d) MYRIAD_LAMBDA { return partial<R>(y[n_original * (1 + d) + k]); }));
            };
            const vec<number, n_original> own{moving(constant_index<c>{})...};
            const vec<number, n_original> f =
                Model::template rhs<number>(t, own, detail::inputs_along_all<Model, Directions, R>(p, R(t), own));
            return vec<R, n_state>{(
                all < n_original ? f[all % n_original].value
                                 : f[all % n_original].derivative.in[all / n_original - (all >= n_original)].value)...};
        } else {
            const auto along_direction = [&](auto k) MYRIAD_LAMBDA {
                constexpr int first = n_original * (1 + decltype(k)::value);
                const vec<dual<R>, n_original> own{dual<R>(y[c], y[first + c])...};
                return Model::template rhs<dual<R>>(
                    t, own, detail::inputs_along<Model, Directions, decltype(k)::value, R>(p, dual<R>(R(t)), own));
            };
            const vec<dual<R>, n_original> f[Directions::count] = {along_direction(constant_index<i>{})...};
            return vec<R, n_state>{(all < n_original
                                        ? f[0][all % n_original].value
                                        : f[all / n_original - (all >= n_original)][all % n_original].derivative)...};
        }
    }
};

}  // namespace myriad::detail
