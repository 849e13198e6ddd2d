// SPDX-License-Identifier: MIT
// Forward sensitivities: a model with the derivatives of its solution with respect to initial states, parameters and
// shared values, by its variational equations in dual numbers.
#pragma once

#include "myriad/kernel/model/mass_matrix.hpp"
#include "myriad/kernel/model/moving_summaries.hpp"
#include "myriad/kernel/model/variations.hpp"

namespace myriad {

/// The ends of the time domain of all phases, by which `with_sensitivities` has derivatives.
enum class time_domain {
    t_begin,  ///< where phases start, unless time is carried on
    t_end,    ///< where they end at the latest
};

}  // namespace myriad

namespace myriad::detail {

/// What an enumerator names: a component of the model, or an end of the time domain.
template <class Model, auto component>
constexpr moving_component moving_of() {
    using E = std::remove_cv_t<decltype(component)>;
    if constexpr (std::is_same_v<E, time_domain>) {
        return {component == time_domain::t_begin ? moving::t_begin : moving::t_end, 0};
    } else {
        constexpr int number = static_cast<int>(component);
        constexpr bool is_state = enumerates_state<Model, E>(), is_parameter = enumerates_parameter<Model, E>(),
                       is_shared = enumerates_shared<Model, E>();
        static_assert(
            is_state || is_parameter || is_shared,
            "with_sensitivities takes enumerators of the model's states, parameters and shared values, and of "
            "myriad::time_domain: with_sensitivities<model, model::k, model::x, myriad::time_domain::t_end>");
        constexpr int count = is_state ? n_state<Model> : is_parameter ? n_parameter<Model> : n_shared<Model>;
        static_assert(number >= 0 && number < count,
                      "with_sensitivities names a component that the model does not have");
        return {is_state ? moving::state : is_parameter ? moving::parameter : moving::shared, number};
    }
}

/// What a model with sensitivities keeps among its accessories, behind those of the model.
template <class Model, int directions>
struct sensitivity_places {
    /// The derivatives of the model's accessories come first.
    static constexpr int time = first_moving_accessory<Model>(directions);
    static constexpr int event_time = time + directions;
    static constexpr int undefined = event_time + 1;
    static constexpr int count = undefined + 1;
    /// Behind them, if an end of the time domain moves, 1 or 0 for the phase: whether it carries on from the last one,
    /// and whether it goes to t_end, and not to an end that `phase_length` counts from t_begin.
    static constexpr int carries_on = count;
    static constexpr int goes_to_t_end = carries_on + 1;
};

/// Directions along given components, in which accessories and times of events move too.
template <class Model, auto... wrt>
struct component_directions {
    static constexpr int count = sizeof...(wrt);
    static constexpr bool carries_accessories = true;
    static constexpr bool keeps_times = true;
    static constexpr moving_component all[] = {moving_of<Model, wrt>()...};
    template <int i>
    static constexpr moving_component at = all[i];
    static constexpr bool move_time_domain = ((moving_of<Model, wrt>().kind == moving::t_begin) || ...) ||
                                             ((moving_of<Model, wrt>().kind == moving::t_end) || ...);
    using places = sensitivity_places<Model, count>;

    /// The derivatives, in direction i, of a phase's begin if it starts at t_begin, and of its end if no event ends it.
    template <class S, int i>
    MYRIAD_FUNCTION static S of_begin() {
        constexpr moving_component its = at<i>;
        return S(real_of<S>(its.kind == moving::t_begin ? 1 : 0));
    }
    template <class S, int i>
    MYRIAD_FUNCTION static S of_end(const auto& wrapped) {
        constexpr moving_component its = at<i>;
        const S at_t_end = wrapped.accessory[places::goes_to_t_end];
        if constexpr (its.kind == moving::t_end) {
            return at_t_end;
        } else {
            return of_begin<S, i>() * (S(real_of<S>(1)) - at_t_end);
        }
    }

    /// How much later neighbouring solutions reach the time of the last action, if it was now.
    template <class R>
    MYRIAD_FUNCTION static vec<R, count> delays_of_action(const auto& wrapped) {
        if (wrapped.t != wrapped.accessory[places::event_time]) return {};
        return detail::part<count>(wrapped.accessory, places::time);
    }

    /// An action after an event, by `cross`, which returns false if it made something jump that has no derivative.
    /// Keeps the time and its derivatives, as the phase may end here. What an action sets has no derivative if the time
    /// of the event has none.
    template <class R>
    MYRIAD_FUNCTION static void cross_at_event(auto& wrapped, const vec<R, count>& dt, auto&& cross) {
        wrapped.accessory[places::event_time] = wrapped.t;
        MYRIAD_UNROLL
        for (int i = 0; i < count; ++i) wrapped.accessory[places::time + i] = is_finite(dt[i]) ? dt[i] : nan_of<R>;
        const auto before = wrapped.accessory;
        bool defined = cross();
        if (MYRIAD_UNLIKELY(!all_finite(dt))) {
            for (int i = 0; i < count; ++i) {
                if (is_finite(dt[i])) continue;
                for (int a = 0; a < n_accessory<Model>; ++a) {
                    const int own = first_moving_accessory<Model>(i) + a;
                    if (wrapped.accessory[a] == before[a] && wrapped.accessory[own] == before[own]) continue;
                    wrapped.accessory[own] = nan_of<R>;
                    defined = false;
                }
            }
        }
        if (!defined) wrapped.accessory[places::undefined] += R(1);
    }
};

/// A model that observes also observes the derivatives of its quantities, which are kept beside its summaries.
template <class Model, class Directions>
struct observing : with_variations<Model, Directions> {};
template <class Model, class Directions>
requires has_summaries<Model>
struct observing<Model, Directions> : with_variations<Model, Directions> {
private:
    static constexpr int n = detail::n_state<Model>, n_own_observed = detail::n_observed<Model>,
                         count = Directions::count;

public:
    static constexpr int n_observed =
        n_own_observed * (1 + count);  ///< the quantities, their derivatives in each direction
    static constexpr int n_companion = detail::n_summary<Model> * count;  ///< the derivatives of summaries
    /// The derivative of summary i / count in direction i % count.
    template <int i>
    static constexpr companion companion_at = {
        n_own_observed * (1 + i % count) + summary_at<Model, i / count>.quantity,
        summary_at<Model, i / count>.quantity,
        summary_at<Model, i / count>.kind,
        (1 + i % count) * detail::n_accessory<Model> + summary_at<Model, i / count>.accessory,
        sensitivity_places<Model, count>::event_time,
        sensitivity_places<Model, count>::time + i % count};

    template <class R>
    MYRIAD_FUNCTION static vec<R, n_observed> observe(auto t, const auto& y, const auto& p) {
        using number = moving_number<Directions, R>;
        vec<number, n> moving;
        static_for<0, n>([&](auto c) MYRIAD_LAMBDA {
            moving[c] = number(
                y[c], partials<R, count>::each([&](auto d) MYRIAD_LAMBDA { return partial<R>(y[n * (1 + d) + c]); }));
        });
        const vec<number, n_own_observed> q =
            Model::template observe<number>(t, moving, detail::inputs_along_all<Model, Directions, R>(p, R(t), moving));
        vec<R, n_observed> all;
        static_for<0, n_own_observed>([&](auto k) MYRIAD_LAMBDA {
            all[k] = q[k].value;
            static_for<0, count>(
                [&](auto d) MYRIAD_LAMBDA { all[n_own_observed * (1 + d) + k] = q[k].derivative.in[d].value; });
        });
        return all;
    }
};

}  // namespace myriad::detail

namespace myriad {

/// Model with the derivatives of its solution with respect to components of its own, named by their enumerators:
/// initial states, parameters and shared values, or by the ends of the time domain, `time_domain::t_begin` and
/// `time_domain::t_end`. Itself a model: `with_sensitivities<Model, Model::k, Model::x>` has, after the states of
/// Model, `sensitivity(c, i)`, the derivative of state c by component i of the list, which `rhs` called with dual
/// numbers determines; after the accessories of Model `accessory_sensitivity(a, i)`, their derivatives, and
/// `time_sensitivity(i)`, that of the time at which the phase ended. They are derivatives of the numbers beside them:
/// at a given time within a phase, and at its end too. Where an event ended the phase, or an end of the time domain is
/// the component, that time moves with the component. Actions transform derivatives as they transform the distance to a
/// neighbouring solution.
/// `initial_sensitivities(ensemble)` sets them where the solution starts.
///
/// What a derivative at an event needs and does not exist, as where the solution only touches the surface, makes the
/// derivative of an accessory NaN and ends the instance as `not_finite` where it is one of a state; `undefined` counts
/// such events. Maxima, minima and integrals over the phase have derivatives too, the times of extrema NaN.
///
/// Model's functions, hooks included, are called with dual numbers: their variables must be `auto` or R, the functions
/// they call those of `myriad`. `rhs` may jump only at an event with `after_event`.
template <class Model, auto... wrt>
struct with_sensitivities : detail::observing<Model, detail::component_directions<Model, wrt...>> {
    static_assert(sizeof...(wrt) > 0,
                  "with_sensitivities needs at least one component: "
                  "with_sensitivities<model, model::k>");
    static_assert(!detail::writes_parameters<Model>,
                  "with_sensitivities takes no model that writes parameters: let its hooks write an accessory instead");
    static_assert(!detail::writes_time_domain<Model>,
                  "with_sensitivities takes no model that writes its time domain: end phases by an event");

    static_assert(!detail::has_delays<Model> ||
                      ((detail::moving_of<Model, wrt>().kind != detail::moving::t_begin) && ...),
                  "with_sensitivities has no derivatives by t_begin of a model with delays, whose past would begin "
                  "elsewhere");
    static_assert(!detail::has_mass_matrix<Model>,
                  "with_sensitivities takes no model with a mass_matrix, which would have to multiply them too");

    /// What it has derivatives by.
    using directions = detail::component_directions<Model, wrt...>;
    using base = detail::observing<Model, directions>;  ///< with the equations of the derivatives
    using base::n_original, base::n_tangent, base::n_state;
    static constexpr int n_directions = directions::count;  ///< number of components that it has derivatives by
    /// Where they lie among the accessories.
    using places = detail::sensitivity_places<Model, n_directions>;

    /// The derivative of state c by component i, among the states.
    MYRIAD_FUNCTION static int sensitivity(int c, int i = 0) { return n_original * (1 + i) + c; }
    /// The derivative of accessory a by component i, among the accessories.
    MYRIAD_FUNCTION static int accessory_sensitivity(int a, int i = 0) {
        return detail::first_moving_accessory<Model>(i) + a;
    }
    /// The derivative by component i of the time at which the phase ended, among the accessories.
    MYRIAD_FUNCTION static int time_sensitivity(int i = 0) { return places::time + i; }
    static constexpr int event_time = places::event_time;  ///< the time of the phase's last event, or of its begin
    static constexpr int undefined = places::undefined;    ///< number of events at which a derivative did not exist
    static constexpr int n_accessory = places::count + (directions::move_time_domain ? 2 : 0);  ///< how many in all

    static constexpr bool keeps_end_of_phase =
        true;  ///< the time at which it ended has the derivatives of what ended it
    /// Calls an action at the instant at which another event, stop or action has ended the phase.
    MYRIAD_FUNCTION static action after_end(auto& wrapped, auto&& hook) {
        const bool known = wrapped.t == wrapped.accessory[event_time];  // else `after_step` has ended it
        const auto of_end = detail::part<n_directions>(wrapped.accessory, places::time);
        const action wanted = detail::action_of([&]() MYRIAD_LAMBDA { return hook(wrapped); });
        if (known) detail::set_part(wrapped.accessory, places::time, of_end);
        return wanted;
    }

    /// The model's own hook, and what derivatives need of the phase's begin.
    MYRIAD_FUNCTION static void initialise(auto& wrapped) {
        using R = std::remove_cvref_t<decltype(wrapped.t)>;
        constexpr bool begins_move = directions::move_time_domain;
        bool continues =
            wrapped.phase != 0 && wrapped.t != wrapped.t_begin && wrapped.t == wrapped.accessory[event_time];
        vec<R, n_directions> dt{};
        if constexpr (begins_move) {
            continues = wrapped.accessory[places::carries_on] != R(0);
            detail::static_for<0, n_directions>(
                [&](auto i) MYRIAD_LAMBDA { dt[i] = directions::template of_begin<R, decltype(i)::value>(); });
        }
        if (wrapped.phase == 0) {
            for (int a = detail::n_accessory<Model>; a < places::count; ++a) wrapped.accessory[a] = R(0);
        } else if (continues) {  // from a time that is another in neighbouring solutions
            dt = detail::part<n_directions>(wrapped.accessory, places::time);
        }
        auto v = detail::part<n_tangent>(wrapped.y, n_original);
        if constexpr (detail::has_delays<Model>) {
            if (wrapped.phase != 0 && !continues) lose_moved_past(wrapped, v);
        }
        [[maybe_unused]] const auto given = detail::part<n_original>(wrapped.y);
        if constexpr (detail::has_initialise<Model>)
            v = detail::move_through<Model, directions>(wrapped, v, dt,
                                                        [](auto& own) MYRIAD_LAMBDA { Model::initialise(own); });
        if constexpr (detail::has_delays<Model>) {
            if (wrapped.phase != 0) lose_moved_jump(wrapped, v, dt, given);
        }
        if constexpr (detail::has_summaries<Model>) moved::begin(wrapped, v, dt);
        if (continues || begins_move) shift(wrapped, v, dt, R(-1));
        detail::set_part(wrapped.y, n_original, v);
        detail::set_part(wrapped.accessory, places::time, dt);
        wrapped.accessory[event_time] = wrapped.t;
        forget_times(wrapped);
    }

    /// The model's own hook, after which derivatives are those of the values at the end, wherever that is.
    MYRIAD_FUNCTION static void finalise(auto& wrapped) {
        using R = std::remove_cvref_t<decltype(wrapped.t)>;
        vec<R, n_directions> dt{};
        auto v = detail::part<n_tangent>(wrapped.y, n_original);
        const bool at_event = wrapped.t == wrapped.accessory[event_time] && wrapped.t != wrapped.t_end;
        const bool at_end = directions::move_time_domain && wrapped.t == wrapped.t_end;
        if (at_event) dt = detail::part<n_directions>(wrapped.accessory, places::time);
        if constexpr (directions::move_time_domain) {
            if (at_end) {
                detail::static_for<0, n_directions>(
                    [&](auto i) MYRIAD_LAMBDA { dt[i] = directions::template of_end<R, decltype(i)::value>(wrapped); });
            }
        }
        if (at_event || at_end) {
            shift(wrapped, v, dt, R(1));
            if constexpr (detail::has_summaries<Model>) moved::extend(wrapped, dt, R(1));
            if (!detail::all_finite(dt)) wrapped.accessory[undefined] += R(1);
        }
        forget_times(wrapped);
        [[maybe_unused]] const auto given = detail::part<n_original>(wrapped.y);
        if constexpr (detail::has_finalise<Model>)
            v = detail::move_through<Model, directions>(wrapped, v, dt,
                                                        [](auto& own) MYRIAD_LAMBDA { Model::finalise(own); });
        if constexpr (detail::has_delays<Model>) lose_moved_jump(wrapped, v, dt, given);
        detail::set_part(wrapped.y, n_original, v);
        detail::set_part(wrapped.accessory, places::time, dt);
    }

private:
    using moved = detail::moving_summaries<Model, directions>;

    /// Follows neighbouring solutions along their slope for `sign` times the time by which each is later.
    template <class R>
    MYRIAD_FUNCTION static void shift(const auto& wrapped, vec<R, n_tangent>& v, const vec<R, n_directions>& dt,
                                      R sign) {
        const auto slope = detail::crossing<Model, directions>::template slope<R>(wrapped);
        for (int i = 0; i < n_directions; ++i)
            for (int c = 0; c < n_original; ++c)
                v[i * n_original + c] = fma(sign * slope[c], dt[i], v[i * n_original + c]);
    }
    /// The past moves to where a phase begins. Where the last one ended at another time in a neighbouring solution, its
    /// past would move by another time: there are no derivatives.
    MYRIAD_FUNCTION static void lose_moved_past(auto& wrapped, auto& v) {
        for (int i = 0; i < n_directions; ++i)
            if (wrapped.accessory[places::time + i] != 0) lose(wrapped, v, i);
    }
    /// The same where a hook lets the state jump at a time that moves: it is not in the list of jumps.
    MYRIAD_FUNCTION static void lose_moved_jump(auto& wrapped, auto& v, const auto& dt, const auto& before) {
        if (detail::same_values(before, detail::part<n_original>(wrapped.y))) return;
        for (int i = 0; i < n_directions; ++i)
            if (dt[i] != 0) lose(wrapped, v, i);
    }
    MYRIAD_FUNCTION static void lose(auto& wrapped, auto& v, int direction) {
        using R = std::remove_cvref_t<decltype(wrapped.t)>;
        for (int c = 0; c < n_original; ++c) v[direction * n_original + c] = nan_of<R>;
        wrapped.accessory[undefined] += R(1);
    }
    MYRIAD_FUNCTION static void forget_times(auto& wrapped) {
        for (int i = 0; i < n_directions; ++i) moved::forget(wrapped, i, false);
    }
};

/// The same, but the errors of the derivatives have no part in choosing the steps, which are those of Model alone:
/// cheaper, with derivatives about as accurate as these steps allow.
template <class Model, auto... wrt>
struct uncontrolled_sensitivities : with_sensitivities<Model, wrt...> {
    static constexpr int n_uncontrolled = with_sensitivities<Model, wrt...>::n_tangent;  ///< the derivatives
};

}  // namespace myriad
