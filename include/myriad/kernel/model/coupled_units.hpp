// SPDX-License-Identifier: MIT
// Coupled units: a model written for one of many units that are alike, as an ordinary model of the whole system, whose
// functions call those of the units one after the other.
#pragma once

#include <array>
#include <concepts>
#include <type_traits>
#include <utility>

#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/core/status.hpp"
#include "myriad/kernel/core/team.hpp"
#include "myriad/kernel/model/hooks.hpp"
#include "myriad/kernel/model/unit_views.hpp"
#include "myriad/kernel/scalar/math.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Largest system whose units are written out, so that their numbers are constants.
inline constexpr int largest_unrolled_system = 16;

/// Calls `f(first)` for every `step`-th unit, from `begin` on, as long as `step` of them are left.
template <int begin, int end, int step, bool unrolled, class F>
MYRIAD_FUNCTION void each_unit(F&& f) {
    if constexpr (unrolled) {
        static_for<0, (end - begin) / step>([&](auto i) MYRIAD_LAMBDA { f(begin + step * decltype(i)::value); });
    } else {
        MYRIAD_ROLLED
        for (int unit = begin; unit + step <= end; unit += step) {
            f(unit);
            MYRIAD_WHOLE_LOOP;
        }
    }
}
template <class Unit, int units, class F>
MYRIAD_FUNCTION void each_unit(F&& f) {
    detail::each_unit<0, units, 1, units * n_unit_state<Unit> <= largest_unrolled_system>(f);
}

/// The number of threads of a GPU that integrate an instance, as units declare it; zero if the library is to choose.
template <class Unit>
constexpr int declared_team() {
    if constexpr (requires { Unit::threads_per_instance; }) {
        return Unit::threads_per_instance;
    } else {
        return 0;
    }
}

/// The inputs of one unit.
template <class Unit, int units, class Inputs>
MYRIAD_FUNCTION auto inputs_of_unit(const Inputs& p, int unit) {
    using S = std::remove_cvref_t<decltype(*first_of(p.parameter))>;
    return unit_inputs<Unit, units, S, typename Inputs::real, Inputs>(p, unit);
}
template <class Unit, int units, class Lane>
MYRIAD_FUNCTION auto lane_of_unit(Lane& lane, int unit) {
    using S = std::remove_cvref_t<decltype(lane.t)>;
    using P = std::remove_pointer_t<decltype(first_of(lane.parameter))>;
    return unit_lane<Unit, units, S, P, Lane>(lane, unit);
}

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

/// Stands for a lane where only the signature of a hook matters.
struct any_lane {};
template <class Unit>
inline constexpr bool units_have_generic_after_step = has_after_step<Unit>&& requires(any_lane lane) {
    Unit::template after_step<double>(0, lane);
};

/// Calls a hook for all units, in their order, and returns the strongest action.
template <class Unit, int units, class Hook>
MYRIAD_FUNCTION action strongest_action(auto& lane, Hook&& hook) {
    action strongest = action::proceed;
    detail::each_unit<Unit, units>([&](int unit) MYRIAD_LAMBDA {
        auto own = detail::lane_of_unit<Unit, units>(lane, unit);
        const action wanted = detail::action_of([&]() MYRIAD_LAMBDA { return hook(unit, own); });
        if (wanted > strongest) strongest = wanted;
    });
    return strongest;
}

/// The summaries of all units.
template <class Unit, int units>
constexpr auto summaries_of_units() {
    constexpr int count = n_summary<Unit>;
    return []<int... i>(std::integer_sequence<int, i...>) {
        return std::array<summary, sizeof...(i)>{summary(
            i / count * n_unit_observed<Unit> + Unit::summaries[i % count].quantity, Unit::summaries[i % count].kind,
            n_accessory<Unit> + i / count * n_unit_accessory<Unit> + Unit::summaries[i % count].accessory)...};
    }
    (std::make_integer_sequence<int, units * count>{});
}

}  // namespace myriad::detail::inline MYRIAD_TARGET

namespace myriad::detail {

// One layer for each optional function, present only if units have it; each inherits the previous one.
namespace unit_layers {

template <class Unit, int units>
struct events_layer : Unit {};
template <class Unit, int units>
requires has_events<Unit>
struct events_layer<Unit, units> : Unit {
    template <class R>
    MYRIAD_FUNCTION static auto events(auto t, const auto& y, const auto& p) {
        constexpr int count = n_unit_event<Unit>;
        vec<R, units * count> values;
        detail::each_unit<Unit, units>([&](int unit) MYRIAD_LAMBDA {
            const unit_states<Unit, units, const R> states{detail::first_of(y), unit};
            const vec<R, count> of_unit =
                Unit::template events<R>(unit, t, states, detail::inputs_of_unit<Unit, units>(p, unit));
            for (int e = 0; e < count; ++e) values[unit * count + e] = of_unit[e];
        });
        return values;
    }
};

template <class Unit, int units>
struct observe_layer : events_layer<Unit, units> {};
template <class Unit, int units>
requires has_observe<Unit>
struct observe_layer<Unit, units> : events_layer<Unit, units> {
    static constexpr auto summaries = detail::summaries_of_units<Unit, units>();

    template <class R>
    MYRIAD_FUNCTION static auto observe(auto t, const auto& y, const auto& p) {
        constexpr int count = n_unit_observed<Unit>;
        vec<R, units * count> values;
        detail::each_unit<Unit, units>([&](int unit) MYRIAD_LAMBDA {
            const unit_states<Unit, units, const R> states{detail::first_of(y), unit};
            const vec<R, count> of_unit =
                Unit::template observe<R>(unit, t, states, detail::inputs_of_unit<Unit, units>(p, unit));
            for (int c = 0; c < count; ++c) values[unit * count + c] = of_unit[c];
        });
        return values;
    }
};

template <class Unit, int units>
struct initialise_layer : observe_layer<Unit, units> {};
template <class Unit, int units>
requires has_initialise<Unit>
struct initialise_layer<Unit, units> : observe_layer<Unit, units> {
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        detail::each_unit<Unit, units>([&](int unit) MYRIAD_LAMBDA {
            auto own = detail::lane_of_unit<Unit, units>(lane, unit);
            Unit::initialise(unit, own);
        });
    }
};

template <class Unit, int units>
struct after_step_layer : initialise_layer<Unit, units> {};
template <class Unit, int units>
requires(has_after_step<Unit> && !units_have_generic_after_step<Unit>) struct after_step_layer<Unit, units>
    : initialise_layer<Unit, units> {
    MYRIAD_FUNCTION static action after_step(auto& lane) {
        return detail::strongest_action<Unit, units>(
            lane, [](int unit, auto& own) MYRIAD_LAMBDA { return Unit::after_step(unit, own); });
    }
};
template <class Unit, int units>
requires units_have_generic_after_step<Unit>
struct after_step_layer<Unit, units> : initialise_layer<Unit, units> {
    template <class R>
    MYRIAD_FUNCTION static mask_of<R> after_step(auto& lane) {
        mask_of<R> stops = mask_of<R>(false);
        detail::each_unit<Unit, units>([&](int unit) MYRIAD_LAMBDA {
            auto own = detail::lane_of_unit<Unit, units>(lane, unit);
            if constexpr (std::is_void_v<decltype(Unit::template after_step<R>(unit, own))>) {
                Unit::template after_step<R>(unit, own);
            } else {
                const mask_of<R> stops_too = Unit::template after_step<R>(unit, own);
                stops = stops || stops_too;
            }
        });
        return stops;
    }
};

template <class Unit, int units>
struct after_event_layer : after_step_layer<Unit, units> {};
template <class Unit, int units>
requires has_after_event<Unit>
struct after_event_layer<Unit, units> : after_step_layer<Unit, units> {
    MYRIAD_FUNCTION static action after_event(int event, auto& lane) {
        const int unit = event / n_unit_event<Unit>;
        auto own = detail::lane_of_unit<Unit, units>(lane, unit);
        return detail::action_of(
            [&]() MYRIAD_LAMBDA { return Unit::after_event(unit, event - unit * n_unit_event<Unit>, own); });
    }
};

template <class Unit, int units>
struct after_stop_layer : after_event_layer<Unit, units> {};
template <class Unit, int units>
requires has_after_stop<Unit>
struct after_stop_layer<Unit, units> : after_event_layer<Unit, units> {
    MYRIAD_FUNCTION static action after_stop(int stop, int number, auto& lane) {
        return detail::strongest_action<Unit, units>(
            lane, [&](int unit, auto& own) MYRIAD_LAMBDA { return Unit::after_stop(unit, stop, number, own); });
    }
};

template <class Unit, int units>
struct finalise_layer : after_stop_layer<Unit, units> {};
template <class Unit, int units>
requires has_finalise<Unit>
struct finalise_layer<Unit, units> : after_stop_layer<Unit, units> {
    MYRIAD_FUNCTION static void finalise(auto& lane) {
        detail::each_unit<Unit, units>([&](int unit) MYRIAD_LAMBDA {
            auto own = detail::lane_of_unit<Unit, units>(lane, unit);
            Unit::finalise(unit, own);
        });
    }
};

}  // namespace unit_layers

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
    static_assert(!has_jacobian<Unit>, "coupled units have no jacobian: it comes from rhs by dual numbers");
    constexpr int team = declared_team<Unit>();
    static_assert(team == 0 || is_size_of_team(team), "threads_per_instance is not a power of two from 1 to 256");
    return check_couplings<Unit, units>();
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
struct coupled_units : detail::unit_layers::finalise_layer<Unit, units> {
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
