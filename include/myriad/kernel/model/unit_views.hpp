// SPDX-License-Identifier: MIT
// The arguments of a unit's functions: states, inputs and lanes of the system as one unit sees them, which can look at
// the others'.
#pragma once

#include <type_traits>
#include <utility>

#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/model/coupling.hpp"
#include "myriad/kernel/model/lane.hpp"

namespace myriad::detail {

/// Throws `error`: a unit of a number that there is not. In the library, since the kernel body has no texts.
[[noreturn]] void refuse_unit(int unit, int units);

}  // namespace myriad::detail

namespace myriad::detail::inline MYRIAD_TARGET {

#if !MYRIAD_FOR_GPU
// clang-format off
[[gnu::error("there is no unit of this number: units are counted from 0 to one less than their number")]]
void no_such_unit() noexcept;
// clang-format on
#endif

/// Returns the number of a unit. The compiler refuses one that optimisation shows to be out of range; builds without
/// NDEBUG check all others, on the CPU.
template <int units>
MYRIAD_FUNCTION int checked_unit(int unit) {
#if !MYRIAD_FOR_GPU
    if (__builtin_constant_p(unit) && (unit < 0 || unit >= units)) no_such_unit();
#if !defined(NDEBUG)
    if (unit < 0 || unit >= units) refuse_unit(unit, units);
#endif
#endif
    return unit;
}

/// The place of the first value; none of an empty vector.
template <class S, int n>
MYRIAD_FUNCTION S* first_of(vec<S, n>& v) {
    if constexpr (n > 0) {
        return v.values;
    } else {
        return nullptr;
    }
}
template <class S, int n>
MYRIAD_FUNCTION const S* first_of(const vec<S, n>& v) {
    return first_of(const_cast<vec<S, n>&>(v));
}

/// The parameters that a team has in its memory.
template <class S>
MYRIAD_FUNCTION S* first_of(S* first) {
    return first;
}

/// Where the components of a unit begin, of which each has `size`, behind `before` of the system.
template <int before, int size, class T>
MYRIAD_FUNCTION T* first_of_unit(T* first, int unit) {
    if constexpr (size > 0) {
        return first + before + unit * size;
    } else {
        return nullptr;
    }
}

/// The enumeration that ends with the count; another type where there is none.
#define MYRIAD_ENUMERATION_OF_COUNT(name, count)              \
    template <class Unit>                                     \
    struct name##_type {                                      \
        using type = void;                                    \
    };                                                        \
    template <class Unit>                                     \
    requires requires { Unit::count; }                        \
    struct name##_type<Unit> {                                \
        using type = std::remove_cv_t<decltype(Unit::count)>; \
    };                                                        \
    template <class Unit>                                     \
    using name##_enumeration = typename name##_type<Unit>::type;
#define MYRIAD_ENUMERATIONS_OF_KIND(kind, ...)  \
    MYRIAD_ENUMERATION_OF_COUNT(kind, n_##kind) \
    MYRIAD_ENUMERATION_OF_COUNT(unit_##kind, n_unit_##kind)
MYRIAD_COMPONENT_KINDS(MYRIAD_ENUMERATIONS_OF_KIND)
MYRIAD_ENUMERATION_OF_COUNT(publication, n_publication)
MYRIAD_ENUMERATION_OF_COUNT(unit_delayed, n_unit_delayed)
#undef MYRIAD_ENUMERATIONS_OF_KIND
#undef MYRIAD_ENUMERATION_OF_COUNT

/// Refuses an index of units' components: any, if there are none, or an enumerator of another kind.
template <class E, int size, class I>
constexpr bool check_unit_index() {
    static_assert(size > 0,
                  "there is no component of this kind: end its enumeration with the enumerator that counts "
                  "them, n_unit_state, n_unit_parameter, n_publication");
    static_assert(!std::is_enum_v<I> || std::is_same_v<I, E>,
                  "this enumerator is of another kind of component: name each by its own enumeration");
    return true;
}
template <class E, int size, class I>
inline constexpr bool unit_index_fits = check_unit_index<E, size, I>();
template <class E, int size, class I>
MYRIAD_FUNCTION int unit_index(I i) {
    static_assert(unit_index_fits<E, size, I>);
    return checked_index<size>(static_cast<int>(i));
}

}  // namespace myriad::detail::inline MYRIAD_TARGET

namespace myriad::inline MYRIAD_TARGET {

/// The components of one kind that a unit, or the system, has: `E` is their enumeration.
template <class T, int size, class E>
struct component_block {
    T* first;  ///< the first of them

    /// Component i; an enumerator of another enumeration does not compile.
    template <class I>
    MYRIAD_FUNCTION T& operator[](I i) const {
        return first[detail::unit_index<E, size>(i)];
    }
};

/// The state of one unit, and through it those of the others: the argument y of `publish`, and `lane.y` of hooks.
template <class Unit, int n, class S>
struct unit_states {
    static constexpr int units = n;  ///< how many units there are
    S* all;                          ///< the states of all units, one unit after the other
    int unit;                        ///< the number of this one

    /// Component c of this unit.
    template <class C>
    MYRIAD_FUNCTION S& operator[](C c) const {
        constexpr int size = detail::n_unit_state<Unit>;
        return all[unit * size + detail::unit_index<detail::unit_state_enumeration<Unit>, size>(c)];
    }
    /// The state of another unit. A constant that is no unit's number does not compile.
    MYRIAD_FUNCTION unit_states of(int other) const { return {all, detail::checked_unit<n>(other)}; }
};

/// The state of one unit alone: the argument y of `diffusion`.
template <class Unit, class S>
struct state_of_unit {
    const S* own;  ///< its states

    /// Component c of this unit.
    template <class C>
    MYRIAD_FUNCTION const S& operator[](C c) const {
        return own[detail::unit_index<detail::unit_state_enumeration<Unit>, detail::n_unit_state<Unit>>(c)];
    }
};

/// The state of one unit with what all have published, and the sums of couplings: the argument y of rhs.
template <class Unit, int n, class R>
struct coupled_states {
    static constexpr int units = n;  ///< how many units there are
    const R* all;                    ///< the states of all units, one unit after the other
    const R* publications;           ///< of all units: publication by publication
    const R* sums;                   ///< of all units: coupling by coupling
    int unit;                        ///< the number of this unit

    /// Component c of this unit.
    template <class C>
    MYRIAD_FUNCTION const R& operator[](C c) const {
        constexpr int size = detail::n_unit_state<Unit>;
        return all[unit * size + detail::unit_index<detail::unit_state_enumeration<Unit>, size>(c)];
    }
    /// What this unit has published.
    template <class P>
    MYRIAD_FUNCTION const R& published(P publication) const {
        constexpr int size = detail::n_publication<Unit>;
        return publications[detail::unit_index<detail::publication_enumeration<Unit>, size>(publication) * n + unit];
    }
    /// The sum of a coupling, by its number among `couplings`.
    template <class C>
    MYRIAD_FUNCTION const R& coupled(C coupling) const {
        return sums[detail::checked_index<detail::n_coupling<Unit>>(static_cast<int>(coupling)) * n + unit];
    }
    /// The same of another unit. A constant that is no unit's number does not compile.
    MYRIAD_FUNCTION coupled_states of(int other) const {
        return {all, publications, sums, detail::checked_unit<n>(other)};
    }
};

/// The accessories of the system and of a unit, if `there`.
template <class Unit, int n, class A, class I, bool there>
struct accessory_blocks {
    component_block<A, detail::n_accessory<Unit>, detail::accessory_enumeration<Unit>> accessory;  ///< of the system
    /// integers of the system
    component_block<I, detail::n_integer_accessory<Unit>, detail::integer_accessory_enumeration<Unit>>
        integer_accessory;
    /// of the unit
    component_block<A, detail::n_unit_accessory<Unit>, detail::unit_accessory_enumeration<Unit>> unit_accessory;
    /// integers of the unit
    component_block<I, detail::n_unit_integer_accessory<Unit>, detail::unit_integer_accessory_enumeration<Unit>>
        unit_integer_accessory;
    /// Made by the library.
    MYRIAD_FUNCTION accessory_blocks(auto& inputs, int unit)
        : accessory{detail::first_of(inputs.accessory)}, integer_accessory{detail::first_of(inputs.integer_accessory)},
          unit_accessory{
              detail::first_of_unit<detail::n_accessory<Unit>, detail::n_unit_accessory<Unit>>(accessory.first, unit)},
          unit_integer_accessory{
              detail::first_of_unit<detail::n_integer_accessory<Unit>, detail::n_unit_integer_accessory<Unit>>(
                  integer_accessory.first, unit)} {}
};
/// None, where accessories are outputs.
template <class Unit, int n, class A, class I>
struct accessory_blocks<Unit, n, A, I, false> {
    MYRIAD_FUNCTION accessory_blocks(auto&, int) {}
};

/// The parameters of the system, and what all instances share.
template <class Unit, class S, class Real>
struct system_blocks {
    component_block<S, detail::n_parameter<Unit>, detail::parameter_enumeration<Unit>> parameter;  ///< of the system
    component_block<const Real, detail::n_shared<Unit>, detail::shared_enumeration<Unit>> shared;  ///< of the system
    /// integers of the system
    component_block<const std::int32_t, detail::n_shared_integer<Unit>, detail::shared_integer_enumeration<Unit>>
        shared_integer;
    /// Made by the library.
    MYRIAD_FUNCTION explicit system_blocks(auto& inputs)
        : parameter{detail::first_of(inputs.parameter)}, shared{inputs.shared}, shared_integer{inputs.shared_integer} {}
};
/// The argument p of what is the same for all units.
template <class Unit, class S, class Real>
struct system_inputs : system_blocks<Unit, const S, Real> {
    using system_blocks<Unit, const S, Real>::system_blocks;

    /// Parameter i.
    template <class I>
    MYRIAD_FUNCTION const S& operator[](I i) const {
        return this->parameter[i];
    }
};

/// The values of the past that a unit reads, if there are any.
template <class Unit, class Data, bool there = (detail::n_unit_delayed<Unit> > 0)>
struct past_of_unit {
    MYRIAD_FUNCTION past_of_unit(const Data&, int) {}
};
template <class Unit, class Data>
struct past_of_unit<Unit, Data, true> {
    using value = std::remove_cvref_t<decltype(*detail::first_of(std::declval<const Data&>().delayed))>;  ///< a number
    /// of the unit, at the time that its function is called for
    component_block<const value, detail::n_unit_delayed<Unit>, detail::unit_delayed_enumeration<Unit>> unit_delayed;
    /// Made by the library.
    MYRIAD_FUNCTION past_of_unit(const Data& data, int unit)
        : unit_delayed{detail::first_of_unit<0, detail::n_unit_delayed<Unit>>(detail::first_of(data.delayed), unit)} {}
};

/// The parameters of the system and of a unit, and what all instances share.
template <class Unit, int n, class S, class Real>
struct parameter_blocks : system_blocks<Unit, S, Real> {
    /// of the unit
    component_block<S, detail::n_unit_parameter<Unit>, detail::unit_parameter_enumeration<Unit>> unit_parameter;
    /// of the unit: the same in all instances
    component_block<const Real, detail::n_unit_shared<Unit>, detail::unit_shared_enumeration<Unit>> unit_shared;
    /// integers of the unit, the same in all instances
    component_block<const std::int32_t, detail::n_unit_shared_integer<Unit>,
                    detail::unit_shared_integer_enumeration<Unit>>
        unit_shared_integer;
    /// Made by the library.
    MYRIAD_FUNCTION parameter_blocks(auto& inputs, int unit)
        : system_blocks<Unit, S, Real>(inputs),
          unit_parameter{detail::first_of_unit<detail::n_parameter<Unit>, detail::n_unit_parameter<Unit>>(
              this->parameter.first, unit)},
          unit_shared{
              detail::first_of_unit<detail::n_shared<Unit>, detail::n_unit_shared<Unit>>(this->shared.first, unit)},
          unit_shared_integer{
              detail::first_of_unit<detail::n_shared_integer<Unit>, detail::n_unit_shared_integer<Unit>>(
                  this->shared_integer.first, unit)} {}
};

/// The argument p of a unit's functions: `p[k]` is parameter k of the system, `p.unit_parameter[k]` of the unit;
/// likewise `p.shared` and `p.unit_shared`, `p.accessory` and `p.unit_accessory`; `p.unit_delayed[d]` is a value of the
/// past.
template <class Unit, int n, class S, class Real, class Inputs>
struct unit_inputs : parameter_blocks<Unit, n, const S, Real>,
                     past_of_unit<Unit, Inputs>,
                     accessory_blocks<Unit, n, const S, const integer_of<S>, !detail::accessories_are_outputs<Unit>> {
    using real = Real;     ///< double or float
    const Inputs& inputs;  ///< those of the system
    int unit;              ///< the number of the unit

    /// Made by the library.
    MYRIAD_FUNCTION unit_inputs(const Inputs& of_system, int of_unit)
        : parameter_blocks<Unit, n, const S, Real>(of_system, of_unit), past_of_unit<Unit, Inputs>(of_system, of_unit),
          accessory_blocks<Unit, n, const S, const integer_of<S>, !detail::accessories_are_outputs<Unit>>(of_system,
                                                                                                          of_unit),
          inputs(of_system), unit(of_unit) {}

    /// Parameter i of the system.
    template <class I>
    MYRIAD_FUNCTION const S& operator[](I i) const {
        return this->parameter[i];
    }
    /// The inputs of another unit.
    MYRIAD_FUNCTION unit_inputs of(int other) const { return {inputs, detail::checked_unit<n>(other)}; }
};

/// The argument of a unit's hooks: what `lane` has of the system, and the unit's own. Hooks of one unit may write what
/// belongs to the system and, by `of`, to other units.
template <class Unit, int n, class S, class P, class Lane>
struct unit_lane : parameter_blocks<Unit, n, P, real_of<S>>,
                   past_of_unit<Unit, Lane>,
                   accessory_blocks<Unit, n, S, integer_of<S>, true> {
    Lane& lane;                       ///< that of the system
    int unit;                         ///< the number of the unit
    const S& t;                       ///< time
    decltype(Lane::t_begin) t_begin;  ///< begin of the time domain
    decltype(Lane::t_end) t_end;      ///< end of the time domain
    const S& h;                       ///< length of the step just taken; 0 before the first
    S& h_next;                        ///< length of the next trial step, which a hook may change
    unit_states<Unit, n, S> y;        ///< the state of the unit; `y.of(other)` of another
    decltype(Lane::index) index;      ///< number of the instance in the ensemble
    decltype(Lane::phase) phase;      ///< number of the phase, from the ensemble's start
    /// Detections of each event of the unit in this phase.
    component_block<const integer_of<S>, detail::n_unit_event<Unit>, detail::unit_event_enumeration<Unit>> event_count;

    /// Made by the library.
    MYRIAD_FUNCTION unit_lane(Lane& of_system, int of_unit)
        : parameter_blocks<Unit, n, P, real_of<S>>(of_system, of_unit), past_of_unit<Unit, Lane>(of_system, of_unit),
          accessory_blocks<Unit, n, S, integer_of<S>, true>(of_system, of_unit), lane(of_system), unit(of_unit),
          t(of_system.t), t_begin(of_system.t_begin), t_end(of_system.t_end), h(of_system.h),
          h_next(of_system.h_next), y{detail::first_of(of_system.y), of_unit}, index(of_system.index),
          phase(of_system.phase), event_count{detail::first_of_unit<0, detail::n_unit_event<Unit>>(
                                      detail::first_of(of_system.event_count), of_unit)} {}

    /// The lane of another unit.
    MYRIAD_FUNCTION unit_lane of(int other) const { return {lane, detail::checked_unit<n>(other)}; }
};

}  // namespace myriad::inline MYRIAD_TARGET
