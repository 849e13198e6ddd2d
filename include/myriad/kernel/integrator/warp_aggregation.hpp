// SPDX-License-Identifier: MIT
// Warp aggregation of rare work: a warp takes as long over it for one thread as for all, so that a thread waits a
// little for others that need it too.
#pragma once

#include <cstdint>

#include "myriad/kernel/core/macros.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Threads that want rare work go on together once this part of the warp's running threads want to, or one of them has
/// waited for so many turns of the loop.
inline constexpr int aggregated_share = 4, longest_wait = 16;

/// Whether a thread that wants to do rare work in this turn of the loop waits for other threads instead. It then
/// changes nothing but `waited`, the number of its turns, so that its results do not depend on the other threads. To be
/// called by all running threads of a warp, with `cannot_wait` in those that must not repeat this turn. Without a GPU
/// no one waits, but in tests of what waiting must not change.
MYRIAD_FUNCTION bool waits_for_warp(bool wants, bool cannot_wait, std::int32_t& waited) {
#if MYRIAD_ON_GPU
    const gpu::lane_mask running = gpu::running_lanes(), wanting = gpu::ballot(running, wants);
    if (!wants) return false;
    const bool goes =
        cannot_wait || gpu::count(wanting) * aggregated_share >= gpu::count(running) || waited >= longest_wait;
    const bool waits = !gpu::any(wanting, goes);
#elif defined(MYRIAD_SIMULATED_WARP)
    const bool waits = wants && !cannot_wait && waited % 4 != 3;
#else
    static_cast<void>(wants), static_cast<void>(cannot_wait);
    const bool waits = false;
#endif
    waited = waits ? waited + 1 : 0;
    return waits;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
