// SPDX-License-Identifier: MIT
// The contents of a model: its numbers of components, hooks and declarations, all read at compile time.
#pragma once

#include <cstddef>
#include <string_view>
#include <type_traits>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/core/team.hpp"
#include "myriad/kernel/model/component_kinds.hpp"

namespace myriad::detail {

/// Number of entries of an array that a model declares, of its entry's type and its bytes: nvcc does not know the
/// length of an array of a class template, which std::size asks for, before `sizeof` has been asked.
template <class Entry, std::size_t bytes>
inline constexpr int length_of_array = static_cast<int>(bytes / sizeof(Entry));

// Counts: the last enumerator of each of the model's enumerations, or zero.
#define MYRIAD_MODEL_COUNT(count)                     \
    template <class Model>                            \
    constexpr extent count##_of() {                   \
        if constexpr (requires { Model::count; }) {   \
            return static_cast<extent>(Model::count); \
        } else {                                      \
            return 0;                                 \
        }                                             \
    }                                                 \
    template <class Model>                            \
    inline constexpr extent count = count##_of<Model>();
#define MYRIAD_COUNT_OF_KIND(kind, ...) MYRIAD_MODEL_COUNT(n_##kind)
MYRIAD_ENUMERATED_KINDS(MYRIAD_COUNT_OF_KIND)
#undef MYRIAD_COUNT_OF_KIND
/// Number of states, the last ones, that event functions do not read (`with_tangents`).
MYRIAD_MODEL_COUNT(n_tangent)
/// Number of states, the last ones, whose errors have no part in choosing the steps.
MYRIAD_MODEL_COUNT(n_uncontrolled)
// Of one unit, in a model of coupled units, and what units publish for each other.
#define MYRIAD_COUNT_OF_UNIT(kind, ...) MYRIAD_MODEL_COUNT(n_unit_##kind)
MYRIAD_COMPONENT_KINDS(MYRIAD_COUNT_OF_UNIT)
#undef MYRIAD_COUNT_OF_UNIT
MYRIAD_MODEL_COUNT(n_unit_observed)
MYRIAD_MODEL_COUNT(n_unit_delayed)
MYRIAD_MODEL_COUNT(n_publication)
/// Number of Wiener processes that the states of a model share; zero if each state has its own.
MYRIAD_MODEL_COUNT(n_noise)
/// Number of coupled units; zero of a model that is written as a whole.
MYRIAD_MODEL_COUNT(n_unit)
#undef MYRIAD_MODEL_COUNT
/// Number of states, the first ones, whose errors choose the steps.
template <class Model>
inline constexpr extent n_controlled = n_state<Model> - n_uncontrolled<Model>;

// Enumerations: `enum state { ..., n_state };`, or an unnamed one, recognised by its count. enumerates_<kind>: whether
// E is the model's enumeration of such components. counts_<kind>: false if the model has the enumeration but not the
// count.
#define MYRIAD_MODEL_ENUMERATION(kind, ...)                                                                       \
    template <class Model, class E>                                                                               \
    constexpr bool enumerates_##kind() {                                                                          \
        bool same = false;                                                                                        \
        if constexpr (requires { typename Model::kind; }) same = std::is_same_v<E, typename Model::kind>;         \
        if constexpr (requires { Model::n_##kind; })                                                              \
            same = same || (std::is_enum_v<E> && std::is_same_v<E, std::remove_cv_t<decltype(Model::n_##kind)>>); \
        return same;                                                                                              \
    }                                                                                                             \
    template <class Model>                                                                                        \
    constexpr bool counts_##kind() {                                                                              \
        if constexpr (requires { typename Model::kind; }) {                                                       \
            return !std::is_enum_v<typename Model::kind> || requires { Model::n_##kind; };                        \
        } else {                                                                                                  \
            return true;                                                                                          \
        }                                                                                                         \
    }
MYRIAD_ENUMERATED_KINDS(MYRIAD_MODEL_ENUMERATION)
#undef MYRIAD_MODEL_ENUMERATION

/// Whether E is one of the model's enumerations of components, of any kind.
template <class Model, class E>
inline constexpr bool enumerates_any = false
#define MYRIAD_ENUMERATES(kind, ...) || enumerates_##kind<Model, E>()
    MYRIAD_ENUMERATED_KINDS(MYRIAD_ENUMERATES)
#undef MYRIAD_ENUMERATES
    ;

template <class Model, class I>
inline constexpr bool is_state_index = enumerates_state<Model, I>();

// Refuses an index of type I into components of a kind: any index if the model has none of them, or an enumerator of
// another kind.
#define MYRIAD_INDEX_CHECK(kind, ...)                                                                                 \
    template <class Model, class I>                                                                                   \
    constexpr bool check_##kind##_index() {                                                                           \
        static_assert(n_##kind<Model> > 0,                                                                            \
                      "the model has no " #kind ": end its enumeration with the enumerator n_" #kind                  \
                      ", which counts them");                                                                         \
        static_assert(!enumerates_any<Model, I> || enumerates_##kind<Model, I>(),                                     \
                      "this enumerator is not a " #kind " of the model: name each component by its own enumeration"); \
        return true;                                                                                                  \
    }                                                                                                                 \
    template <class Model, class I>                                                                                   \
    inline constexpr bool kind##_index_fits = check_##kind##_index<Model, I>();
MYRIAD_PARAMETER_KINDS(MYRIAD_INDEX_CHECK)
MYRIAD_SHARED_KINDS(MYRIAD_INDEX_CHECK)
#undef MYRIAD_INDEX_CHECK

// Declarations: `static constexpr bool name = true;` in the model.
#define MYRIAD_MODEL_DECLARATION(name)             \
    template <class Model>                         \
    constexpr bool declares_##name() {             \
        if constexpr (requires { Model::name; }) { \
            return static_cast<bool>(Model::name); \
        } else {                                   \
            return false;                          \
        }                                          \
    }                                              \
    template <class Model>                         \
    inline constexpr bool name = declares_##name<Model>();
/// The model's hooks write parameters, which are then stored back.
MYRIAD_MODEL_DECLARATION(writes_parameters)
/// The model's hooks write t_begin and t_end, which are then stored back.
MYRIAD_MODEL_DECLARATION(writes_time_domain)
/// Accessories are outputs of hooks for the host: rhs and events do not see them, so that writing one changes no slope.
MYRIAD_MODEL_DECLARATION(accessories_are_outputs)
/// The model branches on its state, so that the CPU runs it one instance at a time.
MYRIAD_MODEL_DECLARATION(scalar_only)
/// Many steps lie between events, so that on the CPU packs as large as those without events pay off.
MYRIAD_MODEL_DECLARATION(rare_events)
/// The right-hand side is so long that on the CPU a copy in every stage would only make the kernel larger.
MYRIAD_MODEL_DECLARATION(large_rhs)
/// The right-hand side does not depend on t, so that stiff methods need no derivative by it.
MYRIAD_MODEL_DECLARATION(autonomous)
/// The diffusion does not depend on the state.
MYRIAD_MODEL_DECLARATION(additive_noise)
#undef MYRIAD_MODEL_DECLARATION

/// The model has derivatives by the ends of its time domain, for which phases tell where they begin and end.
template <class Model>
inline constexpr bool moves_time_domain = false;
template <class Varied>
requires requires { Varied::directions::move_time_domain; }
inline constexpr bool moves_time_domain<Varied> = Varied::directions::move_time_domain;
/// The accessories that tell them so.
template <class Varied>
using phase_marks_of = typename Varied::places;

// Whether a model has a member of that name, whatever its signature: a class that inherits the name twice finds it
// ambiguous. This also finds templates and overloads, which a test of the signature would miss, so that a hook with a
// wrong signature is an error and not ignored.
#define MYRIAD_MEMBER_NAME(hook)                                         \
    namespace hook_names {                                               \
    struct hook##_name {                                                 \
        int hook;                                                        \
    };                                                                   \
    template <class Model>                                               \
    struct with_##hook : Model, hook##_name {};                          \
    }                                                                    \
    template <class Model>                                               \
    constexpr bool names_##hook() {                                      \
        if constexpr (std::is_final_v<Model>) {                          \
            return false;                                                \
        } else {                                                         \
            return !requires { &hook_names::with_##hook<Model>::hook; }; \
        }                                                                \
    }

/// The functions of a model; those of a part of it are the whole's.
#define MYRIAD_HOOK_NAME(hook) \
    MYRIAD_MEMBER_NAME(hook)   \
    template <class Model>     \
    inline constexpr bool has_##hook = names_##hook<whole_of<Model>>();
MYRIAD_HOOK_NAME(rhs)
MYRIAD_HOOK_NAME(jacobian)
MYRIAD_HOOK_NAME(events)
MYRIAD_HOOK_NAME(observe)
MYRIAD_HOOK_NAME(initialise)
MYRIAD_HOOK_NAME(after_step)
MYRIAD_HOOK_NAME(after_event)
MYRIAD_HOOK_NAME(stop_time)
MYRIAD_HOOK_NAME(after_stop)
MYRIAD_HOOK_NAME(condition)
MYRIAD_HOOK_NAME(after_trigger)
MYRIAD_HOOK_NAME(finalise)
MYRIAD_HOOK_NAME(publish)
MYRIAD_HOOK_NAME(delayed_state)
MYRIAD_HOOK_NAME(delayed_unit)
MYRIAD_MEMBER_NAME(is_delayed_slope)
MYRIAD_MEMBER_NAME(lag)
MYRIAD_MEMBER_NAME(history)
MYRIAD_MEMBER_NAME(diffusion)
#define MYRIAD_NAME_OF_COUNT(kind, ...) \
    MYRIAD_MEMBER_NAME(n_##kind)        \
    template <class Model>              \
    inline constexpr bool has_n_##kind = names_n_##kind<Model>();
MYRIAD_ENUMERATED_KINDS(MYRIAD_NAME_OF_COUNT)
#undef MYRIAD_NAME_OF_COUNT
#undef MYRIAD_HOOK_NAME
#undef MYRIAD_MEMBER_NAME

/// Whether steps have to end at times that the model gives.
template <class Model>
inline constexpr bool has_stops = n_stop<Model> > 0;
/// Whether a model reads values of its past.
template <class Model>
inline constexpr bool has_delays = n_delayed<Model> > 0;
/// Whether it gives the states before the beginning; else they are the initial ones.
template <class Model>
inline constexpr bool has_history = has_delays<Model>&& names_history<Model>();
/// Whether steps end before t_end at times that are known: at stops, or where a jump of the past arrives.
template <class Model>
inline constexpr bool has_known_stops = has_stops<Model> || has_delays<Model>;
/// Whether a model has a component or constant `stop_time`, which is no hook.
template <class Model>
inline constexpr bool stop_time_is_a_value = requires {
    sizeof(decltype(Model::stop_time));
};
/// Whether a model has a component or constant `diffusion`, which is no function.
template <class Model>
inline constexpr bool diffusion_is_a_value = requires {
    sizeof(decltype(Model::diffusion));
};
/// Whether a model is a stochastic equation.
template <class Model>
inline constexpr bool has_diffusion = names_diffusion<whole_of<Model>>() && !diffusion_is_a_value<Model>;
/// Whether actions follow conditions of several event functions. A `condition` alone may be a function of the model's.
template <class Model>
inline constexpr bool has_triggers = n_trigger<Model> > 0;

/// Whether other files can name a type: in an anonymous namespace, each file has a type of its own. Recognised by the
/// compiler's spelling of the name.
template <class T>
constexpr bool is_known_elsewhere() {
    constexpr std::string_view name = __PRETTY_FUNCTION__;
    return name.find("{anonymous}") == name.npos && name.find("(anonymous") == name.npos &&
           name.find("<unnamed>") == name.npos;
}
/// Refuses kernels that no other file could call.
template <class Model, class Method>
constexpr bool check_linkage() {
    static_assert(
        is_known_elsewhere<Model>(),
        "the model is in an anonymous namespace, where the file of its kernels and the files that use them do not see "
        "the same type: move it out, into a header that both include");
    static_assert(
        is_known_elsewhere<Method>(),
        "the method is in an anonymous namespace, where the file of the kernels and the files that use them do not "
        "see the same type: move it out, into a header that both include");
    return true;
}

/// Whether a model has its own Jacobian. One that a model with tangents inherits is for the states without tangents,
/// and does not count.
template <class Model>
inline constexpr bool gives_jacobian = has_jacobian<Model>&& n_tangent<Model> == 0;

/// Checks a model as far as possible without calling it; everything that uses a model starts here.
template <class Model>
constexpr bool check_model() {
    static_assert(std::is_class_v<Model>, "a model is a struct with static member functions");
    static_assert(!std::is_final_v<Model>,
                  "the model is declared final: its hooks cannot be found by name; remove `final`");
#define MYRIAD_COUNT_CHECK(kind, ...)                                                               \
    static_assert(counts_##kind<Model>(),                                                           \
                  "the model has an enumeration `" #kind "` without its count: make n_" #kind       \
                  " its last enumerator, `enum " #kind " { ..., n_" #kind " };`, without `class`"); \
    static_assert(                                                                                  \
        !has_n_##kind<Model> || requires { Model::n_##kind; },                                      \
        "the model's n_" #kind " is private: a model is a struct, whose enumerations and functions are public");
    MYRIAD_ENUMERATED_KINDS(MYRIAD_COUNT_CHECK)
#undef MYRIAD_COUNT_CHECK
    static_assert(n_state<Model> > 0,
                  "the model has no state: give it `enum state { x, ..., n_state };` with at least one component");
    static_assert(has_rhs<Model>,
                  "the model has no right-hand side: give it `template <class R> MYRIAD_FUNCTION static "
                  "myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p)`");
    static_assert(has_events<Model> == (n_event<Model> > 0),
                  "a model with events has both `enum event { ..., n_event };` and a function `events`");
    static_assert(!has_after_event<Model> || has_events<Model>,
                  "the model has after_event but no events: give it `enum event { ..., n_event };` and `events`");
    static_assert(
        !has_triggers<Model> || (has_condition<Model> && has_after_trigger<Model> && has_events<Model>),
        "a model with triggers has `enum trigger { ..., n_trigger };`, `condition`, `after_trigger` and events");
    static_assert(!has_after_trigger<Model> || has_triggers<Model>,
                  "the model has after_trigger but no triggers: give it `enum trigger { ..., n_trigger };`");
    static_assert(has_stops<Model> ? has_stop_time<Model> && !stop_time_is_a_value<Model>
                                   : !has_stop_time<Model> || stop_time_is_a_value<Model>,
                  "a model with stop times has both `enum stop { ..., n_stop };` and a function `stop_time`");
    static_assert(
        !has_delays<Model> || (has_delayed_state<Model> && names_lag<Model>()),
        "a model with delays has `enum delayed { ..., n_delayed };` and the functions `delayed_state`, the state "
        "that a delayed value is of, and `lag`, how long ago it is");
    static_assert(!has_after_stop<Model> || has_stops<Model>,
                  "the model has after_stop but no stop times: give it `enum stop { ..., n_stop };` and `stop_time`");
    return true;
}

}  // namespace myriad::detail
