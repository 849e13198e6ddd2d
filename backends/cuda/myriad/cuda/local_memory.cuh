// SPDX-License-Identifier: MIT
// Whether what a step keeps has room in the local memory of a GPU's thread.
#pragma once

#include <cstddef>

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

}  // namespace myriad::detail::inline MYRIAD_TARGET
