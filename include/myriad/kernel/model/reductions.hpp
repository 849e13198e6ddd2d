// SPDX-License-Identifier: MIT
// Reductions: extrema of quantities of a model's `observe`, the times of extrema, and integrals over the phase, each
// with the accessory that receives it. Declared in the model, read at compile time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <type_traits>

#include "myriad/kernel/model/concepts.hpp"

namespace myriad {

/// The reductions of an observed quantity over a phase, along the solution and not only at the ends of steps.
enum class over_phase : std::uint8_t {
    maximum,          ///< the largest value; the ends of the phase count too
    minimum,          ///< the smallest value, likewise
    time_of_maximum,  ///< the first of equal ones; the model must also have the quantity's `maximum`
    time_of_minimum,  ///< the same with the quantity's `minimum`
    integral,         ///< over t: backwards in time, that of a positive quantity is negative
};

}  // namespace myriad

namespace myriad::detail {

/// A variable whose address identifies a type in constant expressions.
template <class E>
inline constexpr char type_mark = 0;

}  // namespace myriad::detail

namespace myriad {

/// An observed quantity, what to compute from it, and the accessory that receives it: `static constexpr
/// myriad::reduction reductions[] = {{height, myriad::over_phase::maximum, highest}};`
struct reduction {
    int quantity;                ///< number of the observed quantity
    over_phase kind;             ///< what is computed from it
    int accessory;               ///< number of the accessory that receives it
    const char* quantity_type;   ///< a mark of the type of the first argument, for checks
    const char* accessory_type;  ///< a mark of the type of the last argument, for checks

    /// From enumerators of `observed` and `accessory`.
    template <class Q, class A>
    constexpr reduction(Q observed, over_phase kind_, A receiver)
        : quantity(static_cast<int>(observed)), kind(kind_), accessory(static_cast<int>(receiver)),
          quantity_type(&detail::type_mark<Q>), accessory_type(&detail::type_mark<A>) {}
};

}  // namespace myriad

namespace myriad::detail {

template <class Model>
constexpr int n_reduction_of() {
    if constexpr (requires { std::size(Model::reductions); }) {
        return static_cast<int>(std::size(Model::reductions));
    } else {
        return 0;
    }
}
/// Number of reductions that a model declares.
template <class Model>
inline constexpr int n_reduction = n_reduction_of<Model>();
template <class Model>
inline constexpr bool has_reductions = n_reduction<Model> > 0;
/// A reduction without the type tags, which device code cannot use.
struct unmarked_reduction {
    int quantity;
    over_phase kind;
    int accessory;
};
template <class Model, int i>
inline constexpr unmarked_reduction reduction_at = {Model::reductions[i].quantity, Model::reductions[i].kind,
                                                    Model::reductions[i].accessory};

/// Whether a type tag is that of a number, or of the model's enumeration of such components.
template <class Model>
constexpr bool marks_observed(const char* mark) {
    bool own = mark == &type_mark<int> || mark == &type_mark<std::remove_cv_t<decltype(Model::n_observed)>>;
    if constexpr (requires { typename Model::observed; }) own = own || mark == &type_mark<typename Model::observed>;
    return own;
}
template <class Model>
constexpr bool marks_accessory(const char* mark) {
    bool own = mark == &type_mark<int> || mark == &type_mark<std::remove_cv_t<decltype(Model::n_accessory)>>;
    if constexpr (requires { typename Model::accessory; }) own = own || mark == &type_mark<typename Model::accessory>;
    return own;
}

/// Whether the model has this reduction of the quantity.
template <class Model>
constexpr bool reduces(int quantity, over_phase kind) {
    if constexpr (has_reductions<Model>) {
        for (const reduction& r : Model::reductions)
            if (r.quantity == quantity && r.kind == kind) return true;
    }
    return false;
}
/// The accessory that receives this reduction, or -1.
template <class Model, int quantity, over_phase kind>
inline constexpr int reduced_into = [] {
    for (const reduction& r : Model::reductions)
        if (r.quantity == quantity && r.kind == kind) return r.accessory;
    return -1;
}();
/// Whether the model has a reduction of this kind.
template <class Model, over_phase kind>
inline constexpr bool reduces_any = [] {
    bool found = false;
    for (int quantity = 0; quantity < n_observed<Model>; ++quantity) found = found || reduces<Model>(quantity, kind);
    return found;
}();
template <class Model>
inline constexpr bool seeks_extrema =
    reduces_any<Model, over_phase::maximum> || reduces_any<Model, over_phase::minimum>;

/// Whether rhs and events may read the accessories that reductions write.
template <class Model>
inline constexpr bool sees_reductions = has_reductions<Model> && !accessories_are_outputs<Model>;

/// Checks a model's reductions as far as possible without calling `observe`.
template <class Model>
constexpr bool check_reductions() {
    constexpr bool declared = requires { Model::reductions; };
    static_assert(
        has_observe<Model> == (n_observed<Model> > 0) && has_observe<Model> == declared,
        "a model that observes has all three of `enum observed { ..., n_observed };`, a function `observe`, and "
        "`static constexpr myriad::reduction reductions[] = {{quantity, myriad::over_phase::maximum, accessory}};`");
    if constexpr (declared) {
        static_assert(std::is_same_v<std::remove_cvref_t<decltype(*std::begin(Model::reductions))>, reduction>,
                      "reductions must be `static constexpr myriad::reduction reductions[] = {{quantity, "
                      "myriad::over_phase::maximum, accessory}};`, with one entry or more");
        constexpr auto all_of = [](auto holds) {
            for (const reduction& r : Model::reductions)
                if (!holds(r)) return false;
            return true;
        };
        static_assert(n_accessory<Model> > 0,
                      "a reduction goes into an accessory that the model does not have: give it "
                      "`enum accessory { ..., n_accessory };`");
        static_assert(all_of([](const reduction& r) {
                          return r.quantity >= 0 && r.quantity < n_observed<Model> &&
                                 marks_observed<Model>(r.quantity_type);
                      }),
                      "a reduction names a quantity that is not observed: the first of its three is an enumerator of "
                      "`observed`");
        static_assert(all_of([](const reduction& r) {
                          return r.accessory >= 0 && r.accessory < n_accessory<Model> &&
                                 marks_accessory<Model>(r.accessory_type);
                      }),
                      "a reduction goes into an accessory that the model does not have: the last of its three is an "
                      "enumerator of `accessory`");
        static_assert(all_of([](const reduction& r) {
                          int same = 0;
                          for (const reduction& other : Model::reductions)
                              same += other.accessory == r.accessory ? 1 : 0;
                          return same == 1;
                      }),
                      "two reductions go into the same accessory: give each its own");
        static_assert(all_of([](const reduction& r) {
                          int same = 0;
                          for (const reduction& other : Model::reductions)
                              same += other.quantity == r.quantity && other.kind == r.kind ? 1 : 0;
                          return same == 1;
                      }),
                      "a reduction is declared twice: one accessory receives it");
        static_assert(
            all_of([](const reduction& r) {
                return (r.kind != over_phase::time_of_maximum || reduces<Model>(r.quantity, over_phase::maximum)) &&
                       (r.kind != over_phase::time_of_minimum || reduces<Model>(r.quantity, over_phase::minimum));
            }),
            "the time of an extremum needs the extremum itself, by which it is found: declare the `maximum` or "
            "`minimum` of the quantity as well");
    }
    return true;
}

}  // namespace myriad::detail
