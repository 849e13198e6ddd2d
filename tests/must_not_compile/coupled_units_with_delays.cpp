// case: delayed_values_of_the_system
// expect: the delayed values of coupled units are those of the units
// case: units_with_delays_without_lag
// expect: units with delays have `enum unit_delayed \{ ..., n_unit_delayed \};` and the functions `delayed_state`
// case: lag_of_units_with_the_inputs_first
// expect: lag of coupled units has a wrong signature: it must be
// case: team_for_lags_by_state
// expect: teams of threads take no lags that depend on time or state
// case: delayed_value_of_no_unit
// expect: delayed_state names no state of the model
// case: delayed_value_of_a_later_lag
// expect: same_lag has a wrong result: it is the first of the delayed values
// case: index_of_another_kind
// expect: this enumerator is of another kind of component
// SPDX-License-Identifier: MIT
// Units with delays that do not fit together.
// The first header is precompiled.
// clang-format off
#include <myriad/instantiate.hpp>
#include "myriad/coupled_units.hpp"
#include "myriad/model.hpp"
// clang-format on

struct cell {
    enum unit_state { x, n_unit_state };
    enum parameter { tau, n_parameter };
#if defined CASE_team_for_lags_by_state
    static constexpr int threads_per_instance = 4;
#endif
#if defined CASE_delayed_values_of_the_system
    enum delayed { past, n_delayed };
#endif
    enum unit_delayed { own, next, n_unit_delayed };

    MYRIAD_FUNCTION static int delayed_state(int) { return x; }
    MYRIAD_FUNCTION static int delayed_unit(int unit, int delayed) {
#if defined CASE_delayed_value_of_no_unit
        return unit + delayed;
#else
        return (unit + delayed) % 4;
#endif
    }
#if defined CASE_delayed_value_of_a_later_lag
    MYRIAD_FUNCTION static int same_lag(int) { return next; }
#endif
#if defined CASE_lag_of_units_with_the_inputs_first
    template <class R>
    MYRIAD_FUNCTION static R lag(const auto& p, int, int, int) {
        return p[tau];
    }
#elif defined CASE_team_for_lags_by_state
    template <class R>
    MYRIAD_FUNCTION static R lag(int, int, const R&, const auto& y, const auto&) {
        return y[x];
    }
#elif !defined CASE_units_with_delays_without_lag
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const auto& p) {
        return p[tau];
    }
#endif
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(int, auto, const auto&, const auto& p) {
#if defined CASE_index_of_another_kind
        return myriad::vec<R, 1>{-p.unit_delayed[x]};
#else
        return myriad::vec<R, 1>{p.unit_delayed[next] - p.unit_delayed[own]};
#endif
    }
};
using cells = myriad::coupled_units<cell, 4>;

MYRIAD_INSTANTIATE(cells, myriad::runge_kutta_4)
