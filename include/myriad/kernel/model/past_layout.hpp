// SPDX-License-Identifier: MIT
// Which states a model's delayed values are of, and what the ring of the past holds of each step.
#pragma once

#include <cstdint>

#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/methods/dense.hpp"
#include "myriad/kernel/model/concepts.hpp"

namespace myriad::detail {

/// The number of the first delayed value of the same state as delayed value j, or j.
template <class Model>
MYRIAD_FUNCTION int first_delayed_of_state(int j) {
    for (int k = 0; k < j; ++k)
        if (Model::delayed_state(k) == Model::delayed_state(j)) return k;
    return j;
}
/// Number of different states among the first so many delayed values.
template <class Model>
MYRIAD_FUNCTION int kept_states_of_first(int count) {
    int kept = 0;
    for (int j = 0; j < count; ++j) kept += first_delayed_of_state<Model>(j) == j ? 1 : 0;
    return kept;
}
template <class Model>
MYRIAD_FUNCTION int n_kept_of() {
    if constexpr (has_delays<Model> && has_delayed_state<Model>) {
        return kept_states_of_first<Model>(n_delayed<Model>);
    } else {
        return 0;
    }
}
/// Whether each delayed value is of a state.
template <class Model>
MYRIAD_FUNCTION bool states_of_delays_exist() {
    for (int j = 0; j < n_delayed<Model>; ++j)
        if (Model::delayed_state(j) < 0 || Model::delayed_state(j) >= n_state<Model>) return false;
    return true;
}
/// Number of states whose past is kept.
template <class Model>
inline constexpr int n_kept = n_kept_of<Model>();
/// Where delayed value j is among them.
template <class Model, int j>
inline constexpr int place_of_kept = kept_states_of_first<Model>(first_delayed_of_state<Model>(j));

/// Calls `visit(place, number of the state)` for each state whose past is kept.
template <class Model, class Visit>
MYRIAD_FUNCTION void for_each_kept_state(Visit&& visit) {
    static_for<0, n_delayed<Model>>([&](auto j) MYRIAD_LAMBDA {
        constexpr int number = decltype(j)::value;
        if constexpr (first_delayed_of_state<Model>(number) == number)
            visit(constant_index<place_of_kept<Model, number>>{}, Model::delayed_state(number));
    });
}

/// Numbers that a step has in the ring: the time at its start and, of each state kept, either value and slope there
/// (`terms` = 2), from which and the next step's the cubic Hermite polynomial follows, or the coefficients of the
/// method's own interpolant.
MYRIAD_FUNCTION int history_fields(int kept, int terms) { return 1 + kept * terms; }
/// Numbers that the past of an instance takes: its steps, the initial value of each state kept, and the time by which
/// the steps were moved.
MYRIAD_FUNCTION std::int64_t history_numbers(std::int64_t slots, int kept, int terms) {
    return kept > 0 ? slots * history_fields(kept, terms) + kept + 1 : 0;
}
/// How many numbers of each state a method's interpolant takes.
template <class Method>
inline constexpr int history_terms = [] {
    if constexpr (has_own_interpolant<Method>) {
        return Method::interpolant_degree + 1;
    } else {
        return 2;
    }
}();

}  // namespace myriad::detail
