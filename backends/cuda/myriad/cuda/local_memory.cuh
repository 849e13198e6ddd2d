// SPDX-License-Identifier: MIT
// Whether what a step and delayed values keep has room in the local memory of a GPU's thread, and tables of the past in
// constant memory.
#pragma once

#include <cstddef>

#include "myriad/kernel/model/delay_loop.hpp"
#include "myriad/kernel/model/past.hpp"
#include "myriad/kernel/state/breaking_state.hpp"
#include "myriad/kernel/stepper/step.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The most local memory that a thread may have, in bytes (CUDA C++ Programming Guide, table of technical
/// specifications per compute capability).
inline constexpr std::size_t most_local_memory = 512 << 10;

template <class Model, class Method, class R>
constexpr std::size_t find_bytes_of_step() {
    constexpr std::size_t stages = sizeof(trial_step<Method, R, n_state<Model>>);
    if constexpr (solves_linear_systems<Method>) {
        return stages + sizeof(stage_factors<Model, R>);
    } else {
        return stages;
    }
}
/// Bytes of the stages of a step and, of a stiff method, of its factors.
template <class Model, class Method, class R>
inline constexpr std::size_t bytes_of_step = find_bytes_of_step<Model, Method, R>();

template <class Model, class R>
constexpr std::size_t find_bytes_of_past() {
    if constexpr (has_delays<Model>) {
        return sizeof(past_view<Model, R>) + sizeof(vec<R, n_delayed<Model>>) + sizeof(breaking_state<Model, R>);
    } else {
        return 0;
    }
}
/// Bytes of what a thread keeps for its delayed values.
template <class Model, class R>
inline constexpr std::size_t bytes_of_past = find_bytes_of_past<Model, R>();

/// Bytes of constant memory that the tables of the past take, and the most that a kernel has (the same table).
inline constexpr std::size_t most_constant_memory = 64 << 10;
template <class Model>
constexpr std::size_t find_bytes_of_tables() {
    std::size_t bytes = 0;
    if constexpr (has_delays<Model>) {
        if constexpr (!delay_loop<Model>::is_written_out) bytes += sizeof(tables_of_past<Model>);
        if constexpr (team_size<Model> != 1) bytes += sizeof(places_of_states<whole_of<Model>>);
    }
    return bytes;
}
template <class Model>
inline constexpr std::size_t bytes_of_tables = find_bytes_of_tables<Model>();

}  // namespace myriad::detail::inline MYRIAD_TARGET
