// SPDX-License-Identifier: MIT
// Calls the optional functions of a model: checks their signatures with readable messages, tells scalar from generic
// hooks, and runs a scalar hook on one lane of a pack.
#pragma once

#include <concepts>
#include <type_traits>
#include <utility>

#include "myriad/kernel/core/status.hpp"
#include "myriad/kernel/model/event_signs.hpp"
#include "myriad/kernel/model/jacobian_pattern.hpp"
#include "myriad/kernel/model/lane.hpp"
#include "myriad/kernel/model/noise.hpp"
#include "myriad/kernel/model/recall.hpp"
#include "myriad/kernel/model/summaries.hpp"
#include "myriad/kernel/scalar/matrix_loop.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// `after_step` with an explicit scalar type runs on whole packs, without one on one instance at a time.
template <class Model, class R = double>
inline constexpr bool has_generic_after_step = has_after_step<Model>&& requires(lane<Model, R>& l) {
    Model::template after_step<R>(l);
};

template <class T, class R>
concept generic_hook_result = std::is_void_v<T> || std::same_as<T, mask_of<R>>;

template <class T>
concept hook_result = std::is_void_v<T> || std::same_as<T, action>;

// Refuses a call that does not compile or returns a wrong type, with the message; then makes the call, so that the
// compiler reports the cause: an argument, or that the hook is private.
#define MYRIAD_CHECK_CALL(call, result, what)                    \
    static_assert(                                               \
        requires {                                               \
            { call } -> result;                                  \
        },                                                       \
        what);                                                   \
    if constexpr (!requires { call; }) {                         \
        [[maybe_unused]] decltype(call)* what_the_compiler_says; \
    }

#define MYRIAD_REFUSE_ORDER(name, is_another)                                                                    \
    static_assert(!(is_another), "the arguments of " #name                                                       \
                                 " are exchanged: they are the time, the states and the inputs, in this order, " \
                                 "`auto t, const myriad::vec<R, n_state>& y, const auto& p`");
// Refuses a function of time, states and inputs whose arguments are in another order. Only where the call fails: to try
// another order compiles the body of a function whose type of return is deduced.
#define MYRIAD_CHECK_ORDER(name)                                                                \
    if constexpr (!requires { Model::template name<R>(R{}, *y, *p); }) {                        \
        constexpr bool takes_another_order = requires { Model::template name<R>(*y, R{}, *p); } \
        || requires { Model::template name<R>(R{}, *p, *y); }                                   \
        || requires { Model::template name<R>(*y, *p, R{}); }                                   \
        || requires { Model::template name<R>(*p, R{}, *y); }                                   \
        || requires { Model::template name<R>(*p, *y, R{}); };                                  \
        MYRIAD_REFUSE_ORDER(name, takes_another_order)                                          \
    }
// The same where a call does not fail, as a number is taken for the vector of a single state: by the parameters' types.
#define MYRIAD_HAS_PARAMETERS(name, result, ...) \
    requires { static_cast<result (*)(__VA_ARGS__)>(&Model::template name<R>); }
#define MYRIAD_CHECK_ORDER_OF_ONE(name, result)                                                             \
    if constexpr (n_state<Model> == 1) {                                                                    \
        using state = vec<R, 1>;                                                                            \
        using given = inputs<Model, R>;                                                                     \
        constexpr bool as_told = MYRIAD_HAS_PARAMETERS(name, result, R, const state&, const given&);        \
        constexpr bool states_first = MYRIAD_HAS_PARAMETERS(name, result, const state&, R, const given&) || \
                                      MYRIAD_HAS_PARAMETERS(name, result, state, R, const given&) ||        \
                                      MYRIAD_HAS_PARAMETERS(name, result, const state&, const given&, R) || \
                                      MYRIAD_HAS_PARAMETERS(name, result, state, const given&, R);          \
        MYRIAD_REFUSE_ORDER(name, states_first && !as_told)                                                 \
    }

/// Refuses hooks with a wrong signature, and shows the right one. The arguments' values are unused.
template <class Model, class R>
constexpr bool check_hooks(const vec<R, n_state<Model>>* y = nullptr, const inputs<Model, R>* p = nullptr,
                           lane<Model, R>* l = nullptr) {
    check_model<Model>();
    check_summaries<whole_of<Model>>();
    static_cast<void>(y), static_cast<void>(p), static_cast<void>(l);
    using slopes = vec<R, n_state<Model>>;
    using square = matrix<R, n_state<Model>>;
    using event_values = vec<R, n_event<Model>>;
    using observed_values = vec<R, n_observed<Model>>;
    if constexpr (has_rhs<Model> && n_state<Model> != 0) {
        MYRIAD_CHECK_ORDER(rhs)
        MYRIAD_CHECK_ORDER_OF_ONE(rhs, slopes)
        MYRIAD_CHECK_CALL(
            (Model::template rhs<R>(R{}, *y, *p)), std::same_as<slopes>,
            "rhs has a wrong signature: it must be `template <class R> MYRIAD_FUNCTION static myriad::vec<R, n_state> "
            "rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p)`, and public")
    }
    if constexpr (gives_jacobian<Model>) {
        MYRIAD_CHECK_ORDER(jacobian)
    }
    if constexpr (gives_jacobian<Model> && has_jacobian_pattern<Model>) {
        using derivatives = vec<R, n_declared_entry<Model>>;
        MYRIAD_CHECK_CALL(
            (Model::template jacobian<R>(R{}, *y, *p)), std::same_as<derivatives>,
            "jacobian has a wrong signature: in a model with a jacobian_pattern it must be `template <class R> "
            "MYRIAD_FUNCTION static myriad::vec<R, std::size(jacobian_pattern)> jacobian(auto t, const myriad::vec<R, "
            "n_state>& y, const auto& p)`, the derivatives in the order of the pattern, and public")
    } else if constexpr (gives_jacobian<Model>) {
        MYRIAD_CHECK_CALL(
            (Model::template jacobian<R>(R{}, *y, *p)), std::same_as<square>,
            "jacobian has a wrong signature: it must be `template <class R> MYRIAD_FUNCTION static myriad::matrix<R, "
            "n_state> jacobian(auto t, const myriad::vec<R, n_state>& y, const auto& p)`, df_i/dy_j in row i, column "
            "j, and public")
    }
    if constexpr (has_events<Model> && n_event<Model> != 0) {
        MYRIAD_CHECK_ORDER(events)
        MYRIAD_CHECK_ORDER_OF_ONE(events, event_values)
        MYRIAD_CHECK_CALL(
            (Model::template events<R>(R{}, *y, *p)), std::same_as<event_values>,
            "events has a wrong signature: it must be `template <class R> MYRIAD_FUNCTION static myriad::vec<R, "
            "n_event> events(auto t, const myriad::vec<R, n_state>& y, const auto& p)`, and public")
    }
    if constexpr (has_observe<Model> && n_observed<Model> != 0) {
        MYRIAD_CHECK_ORDER(observe)
        MYRIAD_CHECK_ORDER_OF_ONE(observe, observed_values)
        MYRIAD_CHECK_CALL(
            (Model::template observe<R>(R{}, *y, *p)), std::same_as<observed_values>,
            "observe has a wrong signature: it must be `template <class R> MYRIAD_FUNCTION static myriad::vec<R, "
            "n_observed> observe(auto t, const myriad::vec<R, n_state>& y, const auto& p)`, and public")
    }
    if constexpr (has_diffusion<Model>) {
        using factors = diffusion_type<Model, R>;
        MYRIAD_CHECK_ORDER(diffusion)
        MYRIAD_CHECK_ORDER_OF_ONE(diffusion, factors)
        MYRIAD_CHECK_CALL(
            (Model::template diffusion<R>(R{}, *y, *p)), std::same_as<factors>,
            "diffusion has a wrong signature: it must be `template <class R> MYRIAD_FUNCTION static myriad::vec<R, "
            "n_state> diffusion(auto t, const myriad::vec<R, n_state>& y, const auto& p)`, a factor for each state, "
            "or, in a model with `enum noise { ..., n_noise };`, return myriad::vec<myriad::vec<R, n_noise>, n_state>, "
            "a row for each state, and be public")
    }
    if constexpr (has_initialise<Model>) {
        MYRIAD_CHECK_CALL((Model::initialise(*l)), std::same_as<void>,
                          "initialise has a wrong signature: it must be `MYRIAD_FUNCTION static void initialise(auto& "
                          "lane)`, and public")
    }
    if constexpr (has_generic_after_step<Model, R>) {
        MYRIAD_CHECK_CALL((Model::template after_step<R>(*l)), generic_hook_result<R>,
                          "after_step has a wrong signature: it must be `template <class R> MYRIAD_FUNCTION static "
                          "myriad::mask_of<R> after_step(auto& lane)` (true ends the phase) or return void; to return "
                          "an action, leave out the template parameter")
    }
    if constexpr (has_after_step<Model> && !has_generic_after_step<Model, R>) {
        MYRIAD_CHECK_CALL(
            (Model::after_step(*l)), hook_result,
            "after_step has a wrong signature: it must be `MYRIAD_FUNCTION static myriad::action after_step(auto& "
            "lane)` (one instance at a time; may return void) or, to stay vectorised, `template <class R> "
            "MYRIAD_FUNCTION static myriad::mask_of<R> after_step(auto& lane)` (true ends the phase; may return void), "
            "and public")
    }
    if constexpr (has_after_event<Model>) {
        MYRIAD_CHECK_CALL(
            (Model::after_event(int{}, *l)), hook_result,
            "after_event has a wrong signature: it must be `MYRIAD_FUNCTION static myriad::action after_event(int "
            "event, auto& lane)`, and public; it may return void")
    }
    if constexpr (has_triggers<Model>) {
        MYRIAD_CHECK_CALL((Model::condition(int{}, *static_cast<const event_signs<n_event<Model>>*>(nullptr))),
                          std::same_as<bool>,
                          "condition has a wrong signature: it must be `MYRIAD_FUNCTION static bool condition(int "
                          "trigger, const auto& positive)`, and public")
        MYRIAD_CHECK_CALL((Model::after_trigger(int{}, *l)), hook_result,
                          "after_trigger has a wrong signature: it must be `MYRIAD_FUNCTION static myriad::action "
                          "after_trigger(int trigger, auto& lane)`, and public; it may return void")
    }
    if constexpr (has_stops<Model> && n_stop<Model> != 0) {
        MYRIAD_CHECK_CALL((Model::template stop_time<R>(int{}, int{}, *p)), std::same_as<R>,
                          "stop_time has a wrong signature: it must be `template <class R> MYRIAD_FUNCTION static R "
                          "stop_time(int stop, int number, const auto& p)`, the time of the stop of that number, and "
                          "public")
    }
    if constexpr (has_delays<Model> && has_delayed_state<Model> && !gives_tables_of_past<Model>) {
        static_assert(states_of_delays_exist<whole_of<Model>>(), "delayed_state names no state of the model");
        static_assert(same_lags_are_first<Model>(),
                      "same_lag has a wrong result: it is the first of the delayed values with the lag of that one");
        static_assert(
            requires {
                { Model::template lag<R>(int{}, *p) } -> std::same_as<R>;
            } ||
                requires {
                    { Model::template lag<R>(int{}, R{}, *y, *p) } -> std::same_as<R>;
                },
            "lag has a wrong signature: it must be `template <class R> MYRIAD_FUNCTION static R lag(int delayed, const "
            "auto& p)` or, if it depends on time or state, `R lag(int delayed, const R& t, const myriad::vec<R, "
            "n_state>& y, const auto& p)`, and public");
    }
    if constexpr (has_delayed_slopes<Model>) {
        MYRIAD_CHECK_CALL((Model::is_delayed_slope(int{})), std::same_as<bool>,
                          "is_delayed_slope has a wrong signature: it must be `MYRIAD_FUNCTION static bool "
                          "is_delayed_slope(int delayed)`, and public")
    }
    if constexpr (has_history<Model>) {
        MYRIAD_CHECK_CALL((Model::template history<R>(int{}, R{}, *p)), std::same_as<R>,
                          "history has a wrong signature: it must be `template <class R> MYRIAD_FUNCTION static R "
                          "history(int delayed, const R& t, const auto& p)`, and public")
    }
    if constexpr (has_after_stop<Model>) {
        MYRIAD_CHECK_CALL((Model::after_stop(int{}, int{}, *l)), hook_result,
                          "after_stop has a wrong signature: it must be `MYRIAD_FUNCTION static myriad::action "
                          "after_stop(int stop, int number, auto& lane)`, and public; it may return void")
    }
    if constexpr (has_finalise<Model>) {
        MYRIAD_CHECK_CALL(
            (Model::finalise(*l)), std::same_as<void>,
            "finalise has a wrong signature: it must be `MYRIAD_FUNCTION static void finalise(auto& lane)`, and public")
    }
    return true;
}
#undef MYRIAD_CHECK_ORDER_OF_ONE
#undef MYRIAD_HAS_PARAMETERS
#undef MYRIAD_CHECK_ORDER
#undef MYRIAD_REFUSE_ORDER
#undef MYRIAD_CHECK_CALL

template <class Model, class R>
inline constexpr bool hooks_fit = check_hooks<Model, R>();

/// Whether a hook's return value can end a phase.
template <class Model, class R>
constexpr bool hooks_may_stop() {
    using one_lane = lane<Model, R>;
    if constexpr (has_generic_after_step<Model, R>) {
        if (!std::is_void_v<decltype(Model::template after_step<R>(std::declval<one_lane&>()))>) return true;
    } else if constexpr (has_after_step<Model>) {
        if (!std::is_void_v<decltype(Model::after_step(std::declval<one_lane&>()))>) return true;
    }
    if constexpr (has_after_event<Model>) {
        if (!std::is_void_v<decltype(Model::after_event(0, std::declval<one_lane&>()))>) return true;
    }
    if constexpr (has_triggers<Model>) {
        if (!std::is_void_v<decltype(Model::after_trigger(0, std::declval<one_lane&>()))>) return true;
    }
    if constexpr (has_after_stop<Model>) {
        if (!std::is_void_v<decltype(Model::after_stop(0, 0, std::declval<one_lane&>()))>) return true;
    }
    return false;
}

/// Whether a model's triggers are told which event function has made them fire, by
/// `after_trigger_by(int function, int trigger, auto& lane)` in the place of after_trigger; -1 where an action has,
/// or where the last action was at its crossing too.
template <class Model>
inline constexpr bool triggers_know_their_function = requires {
    requires Model::triggers_know_their_function;
};

/// Calls a hook that returns an action or nothing.
template <class Call>
MYRIAD_FUNCTION action action_of(Call&& call) {
    if constexpr (std::is_void_v<decltype(call())>) {
        call();
        return action::proceed;
    } else {
        return call();
    }
}

/// Whether a model keeps what ended its phase, and so has to be told of actions that come after it at the same instant.
template <class Model>
inline constexpr bool keeps_end_of_phase = requires {
    requires std::is_same_v<decltype(Model::keeps_end_of_phase), const bool>;  // and no component of that name
};

/// Runs a scalar hook on lane i: on the data itself for one instance, on a copy of the lane for a pack.
template <class Model, class S, class Hook>
MYRIAD_FUNCTION action run_on_lane(lane_data<Model, S>& data, int i, Hook&& hook) {
    if constexpr (has_delays<Model>) detail::recall<Model>(data.t, data.y, static_cast<const inputs<Model, S>&>(data));
    if constexpr (has_delays<Model>) data.past.forget_recalled();  // `data` alone knows what the hook changes
    if constexpr (lanes_of<S> == 1) {
        lane<Model, S> view(data);
        return detail::action_of([&]() MYRIAD_LAMBDA { return hook(view); });
    } else {
        lane_data<Model, real_of<S>> one = detail::extract_lane(data, i);
        lane<Model, real_of<S>> view(one);
        const action wanted = detail::action_of([&]() MYRIAD_LAMBDA { return hook(view); });
        detail::insert_lane(data, i, one);
        return wanted;
    }
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
