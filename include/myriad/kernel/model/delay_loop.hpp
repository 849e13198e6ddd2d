// SPDX-License-Identifier: MIT
// Loops over a model's delayed values, the states whose past is kept, and the lags: written out for a few, else through
// tables.
#pragma once

#include <type_traits>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/core/table_loop.hpp"
#include "myriad/kernel/model/past_layout.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Loops over delayed values and lags are written out for so many: more would make kernels of many units long.
inline constexpr int most_delays_written_out = 16;
template <class Model>
using delay_loop = table_loop<(n_delayed<Model> <= most_delays_written_out)>;
/// Which delayed value sees what: as constants, and in memory for loops that are not written out.
template <class Model>
inline constexpr auto tables_of_past_of = make_tables_of_past<Model>();
template <class Model>
MYRIAD_CONSTANT_MEMORY auto kept_tables_of_past = make_tables_of_past<Model>();
template <class Model, auto table, class I>
MYRIAD_FUNCTION auto in_tables_of_past(I i) {
    if constexpr (gives_tables_of_past<Model>) {
        return (Model::tables_of_past().*table)[i];
    } else if constexpr (std::is_same_v<I, int>) {
        return (kept_tables_of_past<Model>.*table)[i];
    } else {
        return constant_index<(tables_of_past_of<Model>.*table)[I::value]>{};
    }
}
template <class Model>
constexpr auto name_tables_of_past() {
    if constexpr (gives_tables_of_past<Model>) {
        return std::type_identity<std::remove_cvref_t<decltype(Model::tables_of_past())>>();
    } else {
        return std::type_identity<std::remove_cv_t<decltype(tables_of_past_of<Model>)>>();
    }
}
template <class Model>
using tables_type_of_past = typename decltype(name_tables_of_past<Model>())::type;
/// Of a team's whole model: where each state is among those kept.
template <class Whole>
MYRIAD_CONSTANT_MEMORY auto kept_places_of_states = make_places_of_states<Whole>();
/// Where the state of delayed value j is among those kept, the number of its lag, and the first value with a lag.
template <class Model, class J>
MYRIAD_FUNCTION auto place_of_kept(J j) {
    return in_tables_of_past<Model, &tables_type_of_past<Model>::place>(j);
}
template <class Model, class J>
MYRIAD_FUNCTION auto number_of_lag(J j) {
    return in_tables_of_past<Model, &tables_type_of_past<Model>::lag>(j);
}
template <class Model, class G>
MYRIAD_FUNCTION auto first_with_lag(G g) {
    return in_tables_of_past<Model, &tables_type_of_past<Model>::first>(g);
}
/// Calls `visit(place, number of the state)` for each state whose past is kept.
template <class Model, class Visit>
MYRIAD_FUNCTION void for_each_kept_state(Visit&& visit) {
    delay_loop<Model>::template range<0, n_kept<Model>>([&](auto place) MYRIAD_LAMBDA {
        visit(place, static_cast<int>(in_tables_of_past<Model, &tables_type_of_past<Model>::state>(place)));
    });
}
/// Loops over the states of a team's thread.
template <class Model>
using component_loop_of_part = table_loop<(n_state<Model> <= most_delays_written_out)>;
/// Calls `visit(j)` for each delayed value.
template <class Model, class Visit>
MYRIAD_FUNCTION void for_each_delayed(Visit&& visit) {
    delay_loop<Model>::template range<0, n_delayed<Model>>(visit);
}
/// Calls `visit(number, the first delayed value with it)` for each lag.
template <class Model, class Visit>
MYRIAD_FUNCTION void for_each_lag(Visit&& visit) {
    delay_loop<Model>::template range<0, n_lag<Model>>([&](auto g)
                                                           MYRIAD_LAMBDA { visit(g, first_with_lag<Model>(g)); });
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
