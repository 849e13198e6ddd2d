// SPDX-License-Identifier: MIT
// Which states a model's delayed values are of, and what the ring of the past holds of each step.
#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>

#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/core/team.hpp"
#include "myriad/kernel/methods/dense.hpp"
#include "myriad/kernel/model/concepts.hpp"

namespace myriad::detail {

/// Whether delayed value j is the derivative that its state had by time, as in neutral equations.
template <class Model>
inline constexpr bool has_delayed_slopes = has_delays<Model>&& names_is_delayed_slope<Model>();
template <class Model>
MYRIAD_FUNCTION bool is_delayed_slope(int j) {
    if constexpr (has_delayed_slopes<Model>) {
        return Model::is_delayed_slope(j);
    } else {
        return false;
    }
}
/// Whether what is known of a model's delayed values is known when it runs alone: one that is interpreted gives the
/// tables of what is kept, and whether its lags are constant, itself.
template <class Model>
concept gives_tables_of_past = requires {
    Model::tables_of_past();
};
/// Whether each delayed value is of a state.
template <class Model>
MYRIAD_FUNCTION bool states_of_delays_exist() {
    for (int j = 0; j < n_delayed<Model>; ++j)
        if (Model::delayed_state(j) < 0 || Model::delayed_state(j) >= n_state<Model>) return false;
    return true;
}
/// The first delayed value that is as long ago as delayed value j, if the model says so: their jumps arrive together.
template <class Model>
MYRIAD_FUNCTION int first_of_lag(int j) {
    if constexpr (requires {
                      { Model::same_lag(j) } -> std::same_as<int>;
                  }) {
        return Model::same_lag(j);
    } else {
        return j;
    }
}
/// Whether `same_lag` names the first of its values for each.
template <class Model>
MYRIAD_FUNCTION bool same_lags_are_first() {
    for (int j = 0; j < n_delayed<Model>; ++j) {
        const int first = first_of_lag<Model>(j);
        if (first < 0 || first > j || first_of_lag<Model>(first) != first) return false;
    }
    return true;
}

/// Calls `put(j, place, is_new)` for all delayed values with the place of their state among those kept. Returns how
/// many are kept.
template <class Model>
constexpr int place_states_of_delays(auto&& put) {
    if (!states_of_delays_exist<Model>()) return 1;  // refused elsewhere
    int place_of_state[n_state<Model>] = {}, kept = 0;
    for (int j = 0; j < n_delayed<Model>; ++j) {
        int& place = place_of_state[Model::delayed_state(j)];  // plus one
        const bool is_new = place == 0;
        if (is_new) place = ++kept;
        put(j, place - 1, is_new);
    }
    return kept;
}
/// The same for the lags.
template <class Model>
constexpr int place_lags(auto&& put) {
    if (!same_lags_are_first<Model>()) return 1;  // refused elsewhere
    int place_of_lag[n_delayed<Model>] = {}, lags = 0;
    for (int j = 0; j < n_delayed<Model>; ++j) {
        const int first = first_of_lag<Model>(j);
        if (first == j) place_of_lag[j] = lags++;
        put(j, place_of_lag[first], first == j);
    }
    return lags;
}
template <class Model>
inline constexpr bool knows_past = has_delays<Model>&& has_delayed_state<Model>;
/// Number of states whose past is kept. A part of a model has a place for each of the whole's.
template <class Model>
inline constexpr extent n_kept = [] {
    if constexpr (gives_tables_of_past<Model>) {
        return Model::n_kept;
    } else if constexpr (team_size<Model> != 1) {
        return n_kept<whole_of<Model>>;
    } else if constexpr (knows_past<Model>) {
        return extent(place_states_of_delays<Model>([](int, int, bool) {}));
    } else {
        return extent(0);
    }
}();
/// Number of lags whose jumps arrive at different times; of a part of a model, those of its own delayed values.
template <class Model>
inline constexpr extent n_lag = [] {
    if constexpr (gives_tables_of_past<Model>) {
        return Model::n_lag;
    } else if constexpr (knows_past<Model>) {
        return extent(place_lags<Model>([](int, int, bool) {}));
    } else {
        return extent(0);
    }
}();
/// The team whose threads have lags of their own; one thread where they have the same.
template <class Model>
constexpr int threads_with_own_lags() {
    if constexpr (team_size<Model> == 1) {
        return 1;
    } else {
        return as_part<Model>::has_own_lags ? team_size<Model> : 1;
    }
}
template <class Model>
using team_of_lags = thread_team<threads_with_own_lags<Model>()>;
/// What of the past is kept, and which delayed value sees what of it.
template <class Model>
struct tables_of_past {
    int place[n_delayed<Model>];  // of each delayed value: that of its state among the states that are kept
    int lag[n_delayed<Model>];    // and that of its lag among the lags
    int state[n_kept<Model>];     // the states that are kept
    int first[n_lag<Model>];      // the first delayed value of each lag
};
template <class Model>
constexpr auto make_tables_of_past() {
    tables_of_past<Model> tables = {};
    const auto put = [](int* place, int* first, int j, int at, int value, bool is_new) {
        place[j] = at;
        if (is_new) first[at] = value;
    };
    if constexpr (team_size<Model> == 1) {  // in a team, which states these are depends on the thread
        place_states_of_delays<Model>([&](int j, int at, bool is_new) {
            put(tables.place, tables.state, j, at, Model::delayed_state(j), is_new);
        });
    }
    place_lags<Model>([&](int j, int at, bool is_new) { put(tables.lag, tables.first, j, at, j, is_new); });
    return tables;
}
/// The place of each state among those kept; -1 for others.
template <class Model>
struct places_of_states {
    int place[n_state<Model>];
};
template <class Model>
constexpr auto make_places_of_states() {
    places_of_states<Model> of = {};
    for (int& place : of.place) place = -1;
    place_states_of_delays<Model>([&](int j, int at, bool) { of.place[Model::delayed_state(j)] = at; });
    return of;
}

/// Numbers that a step has in the ring: the time at its start and, of each state kept, either value and slope there
/// (`terms` = 2), from which and the next step's the cubic Hermite polynomial follows, or the coefficients of the
/// method's own interpolant.
MYRIAD_FUNCTION int history_fields(int kept, int terms) { return 1 + kept * terms; }
/// Numbers kept of each jump besides its entry in the list of jumps: breaking_points.hpp.
template <class Model>
inline constexpr int jump_numbers = [] {
    if constexpr (requires { requires std::is_same_v<decltype(Model::n_jump_numbers), const int>; }) {
        return Model::n_jump_numbers;
    } else {
        return 0;
    }
}();
/// Numbers that the past of an instance takes: its steps, the initial value of each state kept, the time by which the
/// steps were moved, that at which they began, and those of each jump.
MYRIAD_FUNCTION std::int64_t history_numbers(std::int64_t slots, int kept, int terms, int of_jump) {
    return kept > 0 ? slots * (history_fields(kept, terms) + of_jump) + kept + 2 : 0;
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
