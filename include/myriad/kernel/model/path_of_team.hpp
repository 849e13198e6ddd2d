// SPDX-License-Identifier: MIT
// What a method takes of a path over a step: of all processes of a model, or, in a thread of a team, of those of its
// units, which are numbered as in the whole system.
#pragma once

#include "myriad/kernel/core/team.hpp"
#include "myriad/kernel/model/noise.hpp"
#include "myriad/kernel/model/path_tree.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Calls `put(c, group, k)` for the process of each of a thread's states: number k of a group, which `draw(number)`
/// gives. A group whose processes belong to several threads is drawn by each of them; units whose states fill whole
/// groups share none.
template <class Model, class S, class Draw, class Put>
MYRIAD_FUNCTION void each_process_of_thread(Draw&& draw, Put&& put) {
    constexpr int per_group = normals_per_block<real_of<S>>;
    int drawn = -1;
    decltype(draw(0)) of_group{};
    MYRIAD_UNROLL
    for (int c = 0; c < MYRIAD_LENGTH(n_state<Model>); ++c) {
        const int process = detail::whole_state<Model>(c), group = process / per_group;
        if (group != drawn) of_group = draw(group);
        drawn = group;
        MYRIAD_UNROLL
        for (int k = 0; k < per_group; ++k)
            if (k == process % per_group) put(c, of_group, k);
    }
}

template <class Model, class S>
MYRIAD_FUNCTION vec<S, n_wiener<Model>> increments_of_model(const path_interval<S>& over) {
    if constexpr (team_size<Model> == 1) {
        return detail::path_increments<n_wiener<Model>>(over);
    } else {
        const bool whole_cell = detail::is_one_cell(over);
        vec<S, n_wiener<Model>> dw;
        detail::each_process_of_thread<Model, S>(
            [&](int group) MYRIAD_LAMBDA { return detail::increments_of_group(over, whole_cell, group); },
            [&](int c, const auto& of_group, int k) MYRIAD_LAMBDA { dw[c] = of_group[k]; });
        return dw;
    }
}

/// The same with integrals, `of_group(number)` those of a group of processes.
template <class Model, class S, class Group>
MYRIAD_FUNCTION increments_with_integrals<S, n_wiener<Model>> integrals_of_thread(Group&& of_group) {
    increments_with_integrals<S, n_wiener<Model>> all;
    detail::each_process_of_thread<Model, S>(of_group, [&](int c, const auto& found, int k) MYRIAD_LAMBDA {
        all.increment[c] = found.increment[k];
        all.integral[c] = found.integral[k];
    });
    return all;
}
template <class Model, class S>
MYRIAD_FUNCTION increments_with_integrals<S, n_wiener<Model>> integrals_of_model(const path_interval<S>& over) {
    if constexpr (team_size<Model> == 1) {
        return detail::path_integrals<n_wiener<Model>>(over);
    } else {
        const bool whole_cell = detail::is_one_cell(over);
        return detail::integrals_of_thread<Model, S>(
            [&](int group) MYRIAD_LAMBDA { return detail::integrals_of_group(over, whole_cell, group); });
    }
}
template <class Model, class S>
MYRIAD_FUNCTION increments_with_integrals<S, n_wiener<Model>> integrals_of_model(const tree_interval<S>& over) {
    if constexpr (team_size<Model> == 1) {
        return detail::tree_integrals<n_wiener<Model>>(over);
    } else {
        const mask_of<S> is_node = over.length != typename path_integers<S>::small(0);
        return detail::integrals_of_thread<Model, S>(
            [&](int group) MYRIAD_LAMBDA { return detail::tree_integrals_of_group(over, is_node, group); });
    }
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
