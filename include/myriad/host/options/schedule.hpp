// SPDX-License-Identifier: MIT
// The schedules, by themselves: model files need no other option.
#pragma once

#include <cstdint>

namespace myriad {

/// The order in which instances are integrated. Results do not depend on it, bit for bit; the time does if costs
/// differ. `in_order`: by index, one instance per CUDA thread, one contiguous part per CPU thread. `dynamic`: by index,
/// each lane taking the next instance when it is done with its last. `by_cost`: dynamic in the first phase, whose steps
/// are counted; the other phases after sorting by that count, so that neighbouring instances in a warp have similar
/// costs (a solver sorts by the last call's counts as long as the instances stay on the GPU). `automatic`: on the CPU
/// dynamic; on a GPU by_cost if there is step-size control, events or after_step, at least four phases, and more
/// instances than one for each thread of a warp on every warp scheduler, otherwise dynamic if steps lie in shared
/// memory and more instances wait than run at the same time, else in_order. Kernels with fixed steps and without events
/// and after_step always run in order on a GPU. With by_cost on the CPU, no instance is done before all have completed
/// their first phase.
enum class schedule : std::uint8_t {
    automatic,  ///< chosen by device, model and number of instances
    in_order,   ///< by index, fixed beforehand
    dynamic,    ///< by index, each lane or thread taking the next when it is done
    by_cost,    ///< the most expensive first, by the trial steps of the first phase or of the last call
};
/// The name of a schedule, as in the code.
constexpr const char* name_of(schedule s) {
    constexpr const char* names[] = {"automatic", "in_order", "dynamic", "by_cost"};
    return names[static_cast<int>(s)];
}

}  // namespace myriad
