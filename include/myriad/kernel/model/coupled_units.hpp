// SPDX-License-Identifier: MIT
// Coupled units: a model written for one of many units that are alike, as an ordinary model of the whole system, whose
// functions call those of the units one after the other.
#pragma once

#include <concepts>
#include <type_traits>
#include <utility>

#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/core/status.hpp"
#include "myriad/kernel/core/team.hpp"
#include "myriad/kernel/model/delays_of_units.hpp"
#include "myriad/kernel/model/forwarded_hooks.hpp"
#include "myriad/kernel/model/unit_hooks.hpp"
#include "myriad/kernel/scalar/math.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Refuses functions of units with a wrong signature, and shows the right one. The arguments' values are unused.
template <class Unit, class R, class T, class States, class Inputs>
constexpr bool check_publish(const T* t = nullptr, States* y = nullptr, Inputs* p = nullptr) {
    static_cast<void>(t), static_cast<void>(y), static_cast<void>(p);
    static_assert(
        requires {
            { Unit::template publish<R>(int{}, *t, *y, *p) } -> std::same_as<vec<R, n_publication<Unit>>>;
        },
        "publish has a wrong signature: it must be `template <class R> MYRIAD_FUNCTION static myriad::vec<R, "
        "n_publication> publish(int unit, auto t, const auto& y, const auto& p)`, with a value for each publication, "
        "and public");
    return true;
}
template <class Unit, class R, class T, class States, class Inputs>
inline constexpr bool publish_fits = check_publish<Unit, R, T, States, Inputs>();
template <class Unit, class R, class T, class States, class Inputs>
constexpr bool check_unit_rhs(const T* t = nullptr, States* y = nullptr, Inputs* p = nullptr) {
    static_cast<void>(t), static_cast<void>(y), static_cast<void>(p);
    static_assert(
        requires {
            { Unit::template rhs<R>(int{}, *t, *y, *p) } -> std::same_as<vec<R, n_unit_state<Unit>>>;
        },
        "rhs of coupled units has a wrong signature: it must be `template <class R> MYRIAD_FUNCTION static "
        "myriad::vec<R, n_unit_state> rhs(int unit, auto t, const auto& y, const auto& p)`, with a slope for each "
        "state of a unit, and public");
    return true;
}
template <class Unit, class R, class T, class States, class Inputs>
inline constexpr bool rhs_fits = check_unit_rhs<Unit, R, T, States, Inputs>();

/// What one unit publishes, into its places among `published`.
template <class Unit, int units, class R>
MYRIAD_FUNCTION void publish_of_unit(int unit, const auto& t, const R* y, const auto& p, R* published) {
    constexpr int count = n_publication<Unit>;
    const unit_states<Unit, units, const R> states{y, unit};
    const auto inputs = detail::inputs_of_unit<Unit, units>(p, unit);
    static_assert(publish_fits<Unit, R, std::remove_cvref_t<decltype(t)>, decltype(states), decltype(inputs)>);
    const auto values = Unit::template publish<R>(unit, t, states, inputs);
    MYRIAD_UNROLL
    for (int c = 0; c < count; ++c) published[c * units + unit] = values[c];
}

/// The slopes of one unit, into its places among `slopes`; of the others it reads what they have published.
template <class Unit, int units, class R>
MYRIAD_FUNCTION void slopes_of_unit(int unit, const auto& t, const R* y, const auto& p, const R* published,
                                    const R* sums, R* slopes) {
    constexpr int count = n_unit_state<Unit>;
    const coupled_states<Unit, units, R> states{y, published, sums, unit};
    const auto inputs = detail::inputs_of_unit<Unit, units>(p, unit);
    static_assert(rhs_fits<Unit, R, std::remove_cvref_t<decltype(t)>, decltype(states), decltype(inputs)>);
    const auto values = Unit::template rhs<R>(unit, t, states, inputs);
    MYRIAD_UNROLL
    for (int c = 0; c < count; ++c) slopes[unit * count + c] = values[c];
}

/// The sums of the units `unit_of(0)` to `unit_of(rows - 1)`, together so that their additions do not wait for each
/// other; each in the order of its row, so that they have the same bits however units are taken together. On a GPU the
/// entries of so many columns are loaded at a time.
template <class Unit, int units, int k, int rows, int columns, class R, class Real>
MYRIAD_FUNCTION vec<R, rows> sum_coupling(auto&& unit_of, const Real* matrix, const R* published) {
    constexpr coupling_layout layout = coupling_layout_of<Unit, units, k>;
    constexpr int entries = layout.entries_of_row();
    const R* of_all = published + layout.publication * units;
    vec<R, rows> sums;
    MYRIAD_UNROLL
    for (int r = 0; r < rows; ++r) sums[r] = R(0);
    MYRIAD_UNROLL_BY(columns)
    for (int e = 0; e < entries; ++e) {
        MYRIAD_UNROLL
        for (int r = 0; r < rows; ++r) {
            const int column = layout.column(unit_of(r), e);
            if constexpr (layout.shape == coupling_shape::banded) {
                if (!layout.in_matrix(column)) continue;
            }
            sums[r] = fma(matrix[layout.entry(unit_of(r), e)], of_all[column], sums[r]);
        }
    }
    return sums;
}

/// All sums of couplings; `first` is where the entries of the first matrix lie.
template <class Unit, int units, class R, class Real>
MYRIAD_FUNCTION void sum_couplings(const Real* first, const R* published, R* sums) {
    constexpr int together = 4;
    static_for<0, n_coupling<Unit>>([&](auto k) MYRIAD_LAMBDA {
        constexpr int number = decltype(k)::value;
        constexpr bool unrolled = units * n_unit_state<Unit> <= largest_unrolled_system;
        const Real* matrix = first + first_coupling_entry<Unit, units, number>;
        const auto sum = [&](auto rows, int unit) MYRIAD_LAMBDA {
            constexpr int count = decltype(rows)::value;
            const vec<R, count> found = detail::sum_coupling<Unit, units, number, count, 1>(
                [=](int r) MYRIAD_LAMBDA { return unit + r; }, matrix, published);
            MYRIAD_UNROLL
            for (int r = 0; r < count; ++r) sums[number * units + unit + r] = found[r];
        };
        detail::each_unit<0, units, together, unrolled>([&](int unit)
                                                            MYRIAD_LAMBDA { sum(constant_index<together>{}, unit); });
        detail::each_unit<units / together * together, units, 1, unrolled>(
            [&](int unit) MYRIAD_LAMBDA { sum(constant_index<1>{}, unit); });
    });
}

}  // namespace myriad::detail::inline MYRIAD_TARGET

namespace myriad::detail {

/// The functions and summaries that units have, as those of the system.
template <class Unit, int units>
struct functions_of_units : forwarded_hooks<Unit, unit_hooks<Unit, units>> {};
template <class Unit, int units>
requires has_observe<Unit>
struct functions_of_units<Unit, units> : forwarded_hooks<Unit, unit_hooks<Unit, units>> {
    static constexpr auto summaries = detail::summaries_of_units<Unit, units>();
};

/// Checks what units have, as far as possible without calling it.
template <class Unit, int units>
constexpr bool check_units() {
    static_assert(units >= 1, "there is at least one unit");
    static_assert(n_unit_state<Unit> > 0,
                  "units have no state: give them `enum unit_state { x, ..., n_unit_state };` with at least one "
                  "component");
    static_assert(has_rhs<Unit>,
                  "units have no right-hand side: give them `template <class R> MYRIAD_FUNCTION static myriad::vec<R, "
                  "n_unit_state> rhs(int unit, auto t, const auto& y, const auto& p)`");
    static_assert(n_state<Unit> == 0, "the states of coupled units are those of the units: `enum unit_state`");
    static_assert(n_event<Unit> == 0, "the events of coupled units are those of the units: `enum unit_event`");
    static_assert(n_observed<Unit> == 0, "coupled units observe quantities of the units: `enum unit_observed`");
    static_assert(has_publish<Unit> == (n_publication<Unit> > 0),
                  "units that publish have both `enum publication { ..., n_publication };` and a function `publish`");
    static_assert(has_events<Unit> == (n_unit_event<Unit> > 0),
                  "units with events have both `enum unit_event { ..., n_unit_event };` and a function `events`");
    static_assert(has_observe<Unit> == (n_unit_observed<Unit> > 0),
                  "units that observe have both `enum unit_observed { ..., n_unit_observed };` and a function "
                  "`observe`");
    static_assert(!has_triggers<Unit>, "coupled units have no triggers: give an event an action");
    static_assert(!has_diffusion<Unit> || n_noise<Unit> == 0,
                  "the noise of coupled units is a factor for each state of a unit, each with a Wiener process of its "
                  "own: leave out `enum noise`, or write the system as one model");
    static_assert(!has_jacobian<Unit>, "coupled units have no jacobian: it comes from rhs by dual numbers");
    constexpr int team = declared_team<Unit>();
    static_assert(team == 0 || is_size_of_team(team), "threads_per_instance is not a power of two from 1 to 256");
    return check_delays_of_units<Unit>() && check_couplings<Unit, units>();
}

}  // namespace myriad::detail

namespace myriad {

/// A system of `units` units that are alike, each with the states, parameters, accessories and events that `Unit`
/// enumerates as `unit_state`, `unit_parameter` and so on: itself a model, whose functions call those of `Unit` for one
/// unit after the other. States lie unit by unit, `state_of(unit, c)`; components of other kinds likewise, behind those
/// of the system, which `Unit` enumerates as any model does. The entries of couplings' matrices are the last shared
/// values.
///
/// A right-hand side has three passes: all units publish, the sums of couplings are formed, and every unit gets its
/// slopes. Hooks are called for all units in their order, and the strongest action counts; `after_event` for the unit
/// whose event it is.
template <class Unit, int units>
struct coupled_units : detail::delays_of_units<Unit, units, detail::functions_of_units<Unit, units>> {
    static_assert(detail::check_units<Unit, units>());

    using unit_type = Unit;               ///< what is written for one unit
    static constexpr int n_unit = units;  ///< number of units

    static constexpr int n_state = units * detail::n_unit_state<Unit>;  ///< number of states of all units
    /// Number of parameters: those of the system, then those of the units.
    static constexpr int n_parameter = detail::n_parameter<Unit> + units * detail::n_unit_parameter<Unit>;
    /// Where the entries of couplings begin among the shared values.
    static constexpr int first_coupling = detail::n_shared<Unit> + units * detail::n_unit_shared<Unit>;
    /// Number of shared values: those of the system, those of the units, the entries of couplings.
    static constexpr int n_shared = first_coupling + detail::coupling_entries_before<Unit, units>();
    /// Number of shared integers: those of the system, then those of the units.
    static constexpr int n_shared_integer =
        detail::n_shared_integer<Unit> + units * detail::n_unit_shared_integer<Unit>;
    /// Number of accessories: those of the system, then those of the units.
    static constexpr int n_accessory = detail::n_accessory<Unit> + units * detail::n_unit_accessory<Unit>;
    /// Number of integer accessories: those of the system, then those of the units.
    static constexpr int n_integer_accessory =
        detail::n_integer_accessory<Unit> + units * detail::n_unit_integer_accessory<Unit>;
    static constexpr int n_event = units * detail::n_unit_event<Unit>;        ///< number of events of all units
    static constexpr int n_observed = units * detail::n_unit_observed<Unit>;  ///< number of quantities of all units
    /// A loop over many units is called and not copied into every stage.
    static constexpr bool large_rhs = detail::large_rhs<Unit> || n_state > detail::largest_unrolled_system;

// Where a component of a unit lies among those of its kind.
#define MYRIAD_PLACE_OF_UNIT(kind, ...)                                                                           \
    /** Number of this component of a unit, an enumerator of `unit_<kind>`, among the system's. */                \
    template <class C>                                                                                            \
    static constexpr int kind##_of(int unit, C component) {                                                       \
        static_assert(                                                                                            \
            detail::check_unit_index<detail::unit_##kind##_enumeration<Unit>, detail::n_unit_##kind<Unit>, C>()); \
        return detail::n_##kind<Unit> + detail::checked_unit<units>(unit) * detail::n_unit_##kind<Unit> +         \
               detail::checked_index<detail::n_unit_##kind<Unit>>(static_cast<int>(component));                   \
    }
    MYRIAD_COMPONENT_KINDS(MYRIAD_PLACE_OF_UNIT)
#undef MYRIAD_PLACE_OF_UNIT

    /// The slopes of all units.
    template <class R>
    MYRIAD_FUNCTION static vec<R, n_state> rhs(auto t, const vec<R, n_state>& y, const auto& p) {
        constexpr int publications = detail::n_publication<Unit>, couplings = detail::n_coupling<Unit>;
        vec<R, units * publications> published;
        vec<R, units * couplings> sums;
        vec<R, n_state> slopes;
        const R* const states = detail::first_of(y);
        R* const of_all = detail::first_of(published);
        R* const sums_of_all = detail::first_of(sums);
        if constexpr (publications > 0) {
            detail::each_unit<Unit, units>(
                [&](int unit) MYRIAD_LAMBDA { detail::publish_of_unit<Unit, units, R>(unit, t, states, p, of_all); });
        }
        if constexpr (couplings > 0)
            detail::sum_couplings<Unit, units, R>(p.shared.values + first_coupling, of_all, sums_of_all);
        detail::each_unit<Unit, units>([&](int unit) MYRIAD_LAMBDA {
            detail::slopes_of_unit<Unit, units, R>(unit, t, states, p, of_all, sums_of_all, detail::first_of(slopes));
        });
        return slopes;
    }
};

}  // namespace myriad
