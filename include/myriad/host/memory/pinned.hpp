// SPDX-License-Identifier: MIT
// Pinned (page-locked) host memory, which GPUs copy at the full speed of the bus and asynchronously.
#pragma once

#include <cstddef>

#include "myriad/host/core/error.hpp"
#include "myriad/host/core/weak.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad {

// Weak, since only programs with the CUDA backend define them.
namespace cuda {
/// Pins whole pages of host memory for all devices, through the driver's context of the given one. Throws `error` if
/// the system refuses.
__attribute__((weak)) void pin_memory(int device, void* memory, std::size_t bytes);
__attribute__((weak)) void unpin_memory(void* memory);
}  // namespace cuda

namespace host::inline MYRIAD_ABI {

/// The memory must be unpinned before it is released.
inline void pin_memory(int device, void* memory, std::size_t bytes) {
    auto* const pin = if_defined(&cuda::pin_memory);
    require(pin != nullptr, "memory cannot be pinned: the program was built without the CUDA backend");
    pin(device, memory, bytes);
}
inline void unpin_memory(void* memory) { if_defined (&cuda::unpin_memory)(memory); }

}  // namespace host::inline MYRIAD_ABI
}  // namespace myriad
