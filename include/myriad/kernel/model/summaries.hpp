// SPDX-License-Identifier: MIT
// Summaries: extrema of quantities of a model's `observe`, the times of extrema, and integrals over the phase, each
// with the accessory that receives it. Declared in the model, read at compile time.
#pragma once

#include <cstdint>
#include <iterator>
#include <string_view>
#include <type_traits>

#include "myriad/kernel/model/concepts.hpp"

namespace myriad {

/// The summaries of an observed quantity over a phase, along the solution and not only at the ends of steps.
enum class over_phase : std::uint8_t {
    maximum,          ///< the largest value; the ends of the phase count too
    minimum,          ///< the smallest value, likewise
    time_of_maximum,  ///< the first of equal ones; the model must also have the quantity's `maximum`
    time_of_minimum,  ///< the same with the quantity's `minimum`
    integral,         ///< over t: backwards in time, a positive quantity has a negative integral
};

}  // namespace myriad

namespace myriad::detail {

// Their names tell types apart in constant expressions, and not the addresses of variables: with sanitizers, and with
// -fno-delete-null-pointer-checks, g++ does not take two of these for different before the program is linked.
template <class E>
constexpr std::string_view name_of_type() {
    return __PRETTY_FUNCTION__;
}
/// The name of an enumeration's first enumerator as well, as g++ gives all that have no name the same one.
template <class E, E first>
constexpr std::string_view name_of_type() {
    return __PRETTY_FUNCTION__;
}
constexpr std::uint64_t hash_of(std::string_view text) {  // FNV-1a
    std::uint64_t hash = 14695981039346656037u;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
    return hash;
}
template <class E>
constexpr std::uint64_t type_mark_of() {
    if constexpr (std::is_enum_v<E>) {
        return hash_of(name_of_type<E, static_cast<E>(0)>());
    } else {
        return hash_of(name_of_type<E>());
    }
}
/// A number that identifies a type.
template <class E>
inline constexpr std::uint64_t type_mark = type_mark_of<E>();

}  // namespace myriad::detail

namespace myriad {

/// An observed quantity, what to compute from it, and the accessory that receives it: `static constexpr
/// myriad::summary summaries[] = {{height, myriad::over_phase::maximum, highest}};`
struct summary {
    int quantity;                  ///< number of the observed quantity
    over_phase kind;               ///< what is computed from it
    int accessory;                 ///< number of the accessory that receives it
    std::uint64_t quantity_type;   ///< a mark of the type of the first argument, for checks
    std::uint64_t accessory_type;  ///< a mark of the type of the last argument, for checks

    /// From enumerators of `observed` and `accessory`.
    template <class Q, class A>
    constexpr summary(Q observed, over_phase kind_, A receiver)
        : quantity(static_cast<int>(observed)), kind(kind_), accessory(static_cast<int>(receiver)),
          quantity_type(detail::type_mark<Q>), accessory_type(detail::type_mark<A>) {}
};

}  // namespace myriad

namespace myriad::detail {

template <class Model>
constexpr int n_summary_of() {
    if constexpr (requires { Model::summaries[0]; }) {
        return length_of_array<decltype(Model::summaries[0]), sizeof(Model::summaries)>;
    } else {
        return 0;
    }
}
/// Number of summaries that a model declares.
template <class Model>
inline constexpr int n_summary = n_summary_of<Model>();
template <class Model>
inline constexpr bool has_summaries = n_summary<Model> > 0;
/// A summary without the type tags.
struct unmarked_summary {
    int quantity;
    over_phase kind;
    int accessory;
};
template <class Model, int i>
inline constexpr unmarked_summary summary_at = {Model::summaries[i].quantity, Model::summaries[i].kind,
                                                Model::summaries[i].accessory};

/// A quantity that is kept beside a summary of another: its value where the extremum is, or its integral. It begins a
/// phase with what the model's `initialise` leaves in its accessory. Right after an event that moves with what the
/// quantity is a derivative by, an extremum moves too.
struct companion {
    int quantity;
    int beside;  ///< the quantity of the summary
    over_phase kind;
    int accessory;
    int event_time;  ///< the accessory with the time of the last event
    int moves_by;    ///< that with its derivative
};
/// Their number. Models with sensitivities alone declare them, and not users' models.
template <class Varied>
constexpr int n_companion_of() {
    if constexpr (requires { Varied::n_companion; }) {
        return Varied::n_companion;
    } else {
        return 0;
    }
}
template <class Model>
inline constexpr int n_companion = n_companion_of<Model>();
template <class Varied, int i>
inline constexpr companion companion_at = Varied::template companion_at<i>;

/// Whether a type tag stands for a number, or for the model's enumeration of such components.
template <class Model>
constexpr bool marks_observed(std::uint64_t mark) {
    bool own = mark == type_mark<int> || mark == type_mark<std::remove_cv_t<decltype(Model::n_observed)>>;
    if constexpr (requires { typename Model::observed; }) own = own || mark == type_mark<typename Model::observed>;
    return own;
}
template <class Model>
constexpr bool marks_accessory(std::uint64_t mark) {
    bool own = mark == type_mark<int> || mark == type_mark<std::remove_cv_t<decltype(Model::n_accessory)>>;
    if constexpr (requires { typename Model::accessory; }) own = own || mark == type_mark<typename Model::accessory>;
    return own;
}

/// Whether the model has this summary of the quantity.
template <class Model>
constexpr bool summarises(int quantity, over_phase kind) {
    if constexpr (has_summaries<Model>) {
        for (const summary& r : Model::summaries)
            if (r.quantity == quantity && r.kind == kind) return true;
    }
    return false;
}
/// The accessory that receives this summary, or -1.
template <class Model, int quantity, over_phase kind>
inline constexpr int summarised_into = [] {
    for (const summary& r : Model::summaries)
        if (r.quantity == quantity && r.kind == kind) return r.accessory;
    return -1;
}();
/// Whether the model has a summary of this kind.
template <class Model, over_phase kind>
inline constexpr bool summarises_any = [] {
    bool found = false;
    for (int quantity = 0; quantity < n_observed<Model>; ++quantity) found = found || summarises<Model>(quantity, kind);
    return found;
}();
template <class Model>
inline constexpr bool seeks_extrema =
    summarises_any<Model, over_phase::maximum> || summarises_any<Model, over_phase::minimum>;

/// Whether rhs and events may read the accessories that summaries write.
template <class Model>
inline constexpr bool sees_summaries = has_summaries<Model> && !accessories_are_outputs<Model>;

/// Checks a model's summaries as far as possible without calling `observe`.
template <class Model>
constexpr bool check_summaries() {
    constexpr bool declared = requires { Model::summaries; };
    static_assert(
        has_observe<Model> == (n_observed<Model> > 0) && has_observe<Model> == declared,
        "a model that observes has all three of `enum observed { ..., n_observed };`, a function `observe`, and "
        "`static constexpr myriad::summary summaries[] = {{quantity, myriad::over_phase::maximum, accessory}};`");
    if constexpr (declared) {
        static_assert(std::is_same_v<std::remove_cvref_t<decltype(*std::begin(Model::summaries))>, summary>,
                      "summaries must be `static constexpr myriad::summary summaries[] = {{quantity, "
                      "myriad::over_phase::maximum, accessory}};`, with one entry or more");
        constexpr auto all_of = [](auto holds) {
            for (const summary& r : Model::summaries)
                if (!holds(r)) return false;
            return true;
        };
        static_assert(n_accessory<Model> > 0,
                      "a summary goes into an accessory that the model does not have: give it "
                      "`enum accessory { ..., n_accessory };`");
        static_assert(all_of([](const summary& r) {
                          return r.quantity >= 0 && r.quantity < n_observed<Model> &&
                                 marks_observed<Model>(r.quantity_type);
                      }),
                      "a summary names a quantity that is not observed: the first of its three is an enumerator of "
                      "`observed`");
        static_assert(all_of([](const summary& r) {
                          return r.accessory >= 0 && r.accessory < n_accessory<Model> &&
                                 marks_accessory<Model>(r.accessory_type);
                      }),
                      "a summary goes into an accessory that the model does not have: the last of its three is an "
                      "enumerator of `accessory`");
        static_assert(all_of([](const summary& r) {
                          int same = 0;
                          for (const summary& other : Model::summaries) same += other.accessory == r.accessory ? 1 : 0;
                          return same == 1;
                      }),
                      "two summaries go into the same accessory: give each its own");
        static_assert(all_of([](const summary& r) {
                          int same = 0;
                          for (const summary& other : Model::summaries)
                              same += other.quantity == r.quantity && other.kind == r.kind ? 1 : 0;
                          return same == 1;
                      }),
                      "a summary is declared twice: one accessory receives it");
        static_assert(
            all_of([](const summary& r) {
                return (r.kind != over_phase::time_of_maximum || summarises<Model>(r.quantity, over_phase::maximum)) &&
                       (r.kind != over_phase::time_of_minimum || summarises<Model>(r.quantity, over_phase::minimum));
            }),
            "the time of an extremum needs the extremum itself, by which it is found: declare the `maximum` or "
            "`minimum` of the quantity as well");
    }
    return true;
}

}  // namespace myriad::detail
