// SPDX-License-Identifier: MIT
// What a model is: its counts of components, which hooks it names and what it declares, all read at compile time.
#pragma once

#include <type_traits>

namespace myriad {

// Counts: the last enumerator of each of the model's enumerations; absent ones count zero.
#define MYRIAD_MODEL_COUNT(count)                         \
    template <class Model>                                \
    constexpr int count##_of() {                          \
        if constexpr (requires { Model::count; }) {       \
            return static_cast<int>(Model::count);        \
        } else {                                          \
            return 0;                                     \
        }                                                 \
    }                                                     \
    template <class Model>                                \
    inline constexpr int count = count##_of<Model>();
MYRIAD_MODEL_COUNT(n_state)
MYRIAD_MODEL_COUNT(n_parameter)
MYRIAD_MODEL_COUNT(n_shared)
MYRIAD_MODEL_COUNT(n_shared_integer)
MYRIAD_MODEL_COUNT(n_accessory)
MYRIAD_MODEL_COUNT(n_integer_accessory)
MYRIAD_MODEL_COUNT(n_event)
/// States, at the end of all, that event functions do not read (`with_tangents`).
MYRIAD_MODEL_COUNT(n_tangent)
#undef MYRIAD_MODEL_COUNT

// Declarations: `static constexpr bool name = true;` in the model.
#define MYRIAD_MODEL_DECLARATION(name)                    \
    template <class Model>                                \
    constexpr bool declares_##name() {                    \
        if constexpr (requires { Model::name; }) {        \
            return static_cast<bool>(Model::name);        \
        } else {                                          \
            return false;                                 \
        }                                                 \
    }                                                     \
    template <class Model>                                \
    inline constexpr bool name = declares_##name<Model>();
/// The model's hooks write parameters, which are then stored back.
MYRIAD_MODEL_DECLARATION(writes_parameters)
/// The model's hooks write t_begin and t_end, which are then stored back.
MYRIAD_MODEL_DECLARATION(writes_time_domain)
/// Accessories are what hooks put down for the host: rhs and events do not see them, so that writing one changes no slope.
MYRIAD_MODEL_DECLARATION(accessories_are_outputs)
/// The model branches on its state, so it runs one instance at a time on the CPU.
MYRIAD_MODEL_DECLARATION(scalar_only)
/// Many steps lie between events, so that on the CPU the model is worth as large packs as one without.
MYRIAD_MODEL_DECLARATION(rare_events)
#undef MYRIAD_MODEL_DECLARATION

// Does a model have a member of that name, whatever its signature? A class that inherits the name twice finds it
// ambiguous. That finds templates and overloads too, which a plain look at the signature would miss, so that a hook
// with a wrong signature is an error instead of being ignored.
#define MYRIAD_HOOK_NAME(hook)                                         \
    namespace hook_names {                                             \
    struct hook##_name {                                               \
        int hook;                                                      \
    };                                                                 \
    template <class Model>                                             \
    struct with_##hook : Model, hook##_name {};                        \
    }                                                                  \
    template <class Model>                                             \
    constexpr bool names_##hook() {                                    \
        if constexpr (std::is_final_v<Model>) {                        \
            return false;                                              \
        } else {                                                       \
            return !requires { &hook_names::with_##hook<Model>::hook; }; \
        }                                                              \
    }                                                                  \
    template <class Model>                                             \
    inline constexpr bool has_##hook = names_##hook<Model>();
MYRIAD_HOOK_NAME(rhs)
MYRIAD_HOOK_NAME(jacobian)
MYRIAD_HOOK_NAME(events)
MYRIAD_HOOK_NAME(initialise)
MYRIAD_HOOK_NAME(after_step)
MYRIAD_HOOK_NAME(after_event)
MYRIAD_HOOK_NAME(finalise)
#undef MYRIAD_HOOK_NAME

/// Whether a model has a Jacobian of its own. One that a model with tangents has inherited is that of the states without them.
template <class Model>
inline constexpr bool gives_jacobian = has_jacobian<Model> && n_tangent<Model> == 0;

/// Checks what can be said of a model without calling it; everything that uses a model starts here.
template <class Model>
constexpr bool check_model() {
    static_assert(std::is_class_v<Model>, "a model is a struct with static member functions");
    static_assert(!std::is_final_v<Model>,
                  "the model is declared final: its hooks cannot be found by name; remove `final`");
    static_assert(n_state<Model> > 0,
                  "the model has no state: give it `enum state { x, ..., n_state };` with at least one component");
    static_assert(has_rhs<Model>,
                  "the model has no right-hand side: give it `template <class R> MYRIAD_FUNCTION static "
                  "myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p)`");
    static_assert(has_events<Model> == (n_event<Model> > 0),
                  "a model with events has both `enum event { ..., n_event };` and a function `events`");
    static_assert(!has_after_event<Model> || has_events<Model>,
                  "the model has after_event but no events: give it `enum event { ..., n_event };` and `events`");
    return true;
}

}  // namespace myriad
