// SPDX-License-Identifier: MIT
// The delayed values of a system of units: those of the units, one unit after the other. Delayed value d of a unit is
// of one of its own states, or of a state of the unit that `delayed_unit` names.
#pragma once

#include <type_traits>

#include "myriad/kernel/core/team.hpp"
#include "myriad/kernel/model/past_layout.hpp"
#include "myriad/kernel/model/unit_hooks.hpp"

namespace myriad::detail {

/// The number of threads of a GPU that integrate an instance, as units declare it; zero if the library is to choose.
template <class Unit>
constexpr int declared_team() {
    if constexpr (requires { Unit::threads_per_instance; }) {
        return Unit::threads_per_instance;
    } else {
        return 0;
    }
}

/// Stands for the state and the inputs of a unit where only the signature of a lag matters.
struct any_argument {};
/// What the lags of units depend on: parameters of the system, `lag(delayed, p)`, so that all units have the same ones;
/// those of the unit, `lag(unit, delayed, p)`; or time and state too.
template <class Unit>
concept has_lags_of_system = requires(int i, const any_argument& p) {
    Unit::template lag<double>(i, p);
};
template <class Unit>
concept has_constant_lags_of_units = requires(int i, const any_argument& p) {
    Unit::template lag<double>(i, i, p);
};
template <class Unit>
concept has_changing_lags_of_units = requires(int i, const double& t, const any_argument& a) {
    Unit::template lag<double>(i, i, t, a, a);
};

/// Checks what units have for their past, as far as possible without calling it.
template <class Unit>
constexpr bool check_delays_of_units() {
    static_assert(n_delayed<Unit> == 0,
                  "the delayed values of coupled units are those of the units: `enum unit_delayed { ..., "
                  "n_unit_delayed };`");
    if constexpr (n_unit_delayed<Unit> != 0) {
        static_assert(has_delayed_state<Unit> && names_lag<Unit>(),
                      "units with delays have `enum unit_delayed { ..., n_unit_delayed };` and the functions "
                      "`delayed_state`, the state of a unit that a delayed value is of, and `lag`, how long ago it is");
        static_assert(
            has_lags_of_system<Unit> || has_constant_lags_of_units<Unit> || has_changing_lags_of_units<Unit>,
            "lag of coupled units has a wrong signature: it must be `template <class R> MYRIAD_FUNCTION static R "
            "lag(int delayed, const auto& p)` where all units have the same, `R lag(int unit, int delayed, const auto& "
            "p)` or, if it depends on time or state, `R lag(int unit, int delayed, const R& t, const auto& y, const "
            "auto& p)`, and public");
        static_assert(declared_team<Unit>() <= 1 || !has_changing_lags_of_units<Unit>,
                      "teams of threads take no lags that depend on time or state: leave out threads_per_instance, and "
                      "one thread integrates an instance");
    }
    return true;
}

// Layers over Below, which has the other functions of the system: each for what units have.
template <class Unit, int units, class Below>
struct with_delays_of_units : Below {};
template <class Unit, int units, class Below>
requires(n_unit_delayed<Unit> != 0) struct with_delays_of_units<Unit, units, Below> : Below {
    static constexpr int of_unit = n_unit_delayed<Unit>;
    static constexpr int n_delayed = units * of_unit;  ///< number of delayed values of all units

    MYRIAD_FUNCTION static int delayed_state(int j) {
        int unit = j / of_unit;
        const int state = Unit::delayed_state(j % of_unit);
        if constexpr (has_delayed_unit<Unit>) unit = Unit::delayed_unit(unit, j % of_unit);
        const bool exists = unit >= 0 && unit < units && state >= 0 && state < n_unit_state<Unit>;
        return exists ? unit * n_unit_state<Unit> + state : -1;
    }
    MYRIAD_FUNCTION static int same_lag(int j) {
        const int first = first_of_lag<Unit>(j % of_unit);
        return has_lags_of_system<Unit> ? first : j - j % of_unit + first;
    }
    template <class R>
    MYRIAD_FUNCTION static R lag(int j, const auto& p) requires(has_lags_of_system<Unit>) {
        using S = std::remove_cvref_t<decltype(*first_of(p.parameter))>;
        using real = typename std::remove_cvref_t<decltype(p)>::real;
        return Unit::template lag<R>(j % of_unit, system_inputs<Unit, S, real>(p));
    }
    template <class R>
    MYRIAD_FUNCTION static R lag(int j, const auto& p) requires(has_constant_lags_of_units<Unit>) {
        const int unit = j / of_unit;
        return Unit::template lag<R>(unit, j % of_unit, detail::inputs_of_unit<Unit, units>(p, unit));
    }
    template <class R>
    MYRIAD_FUNCTION static R lag(int j, const R& t, const auto& y,
                                 const auto& p) requires(has_changing_lags_of_units<Unit>) {
        const int unit = j / of_unit;
        using S = std::remove_cvref_t<decltype(y[0])>;
        const unit_states<Unit, units, const S> states{first_of(y), unit};
        return Unit::template lag<R>(unit, j % of_unit, t, states, detail::inputs_of_unit<Unit, units>(p, unit));
    }
};

template <class Unit, int units, class Below>
struct with_slopes_of_units : with_delays_of_units<Unit, units, Below> {};
template <class Unit, int units, class Below>
requires(n_unit_delayed<Unit> != 0 && names_is_delayed_slope<Unit>()) struct with_slopes_of_units<Unit, units, Below>
    : with_delays_of_units<Unit, units, Below> {
    MYRIAD_FUNCTION static bool is_delayed_slope(int j) { return Unit::is_delayed_slope(j % n_unit_delayed<Unit>); }
};

/// The system with what its units have for their past.
template <class Unit, int units, class Below>
struct delays_of_units : with_slopes_of_units<Unit, units, Below> {};
template <class Unit, int units, class Below>
requires(n_unit_delayed<Unit> != 0 && names_history<Unit>()) struct delays_of_units<Unit, units, Below>
    : with_slopes_of_units<Unit, units, Below> {
    template <class R>
    MYRIAD_FUNCTION static R history(int j, const R& t, const auto& p) {
        constexpr int of_unit = n_unit_delayed<Unit>;
        const int unit = j / of_unit;
        return Unit::template history<R>(unit, j % of_unit, t, detail::inputs_of_unit<Unit, units>(p, unit));
    }
    MYRIAD_FUNCTION static bool has_history(int j) {
        if constexpr (requires {
                          { Unit::has_history(j) } -> std::same_as<bool>;
                      }) {
            return Unit::has_history(j % n_unit_delayed<Unit>);
        } else {
            return true;
        }
    }
};

}  // namespace myriad::detail
