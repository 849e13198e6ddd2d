// SPDX-License-Identifier: MIT
// The GPUs of this machine, and host memory that they copy fast.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "myriad/cuda/check.cuh"
#include "myriad/cuda/resources.cuh"
#include "myriad/host/backend/backend.hpp"
#include "myriad/host/memory/pinned.hpp"

namespace myriad::cuda {

/// Number of GPUs; if there are none, `why_none` gives the reason.
inline int count_devices(std::string& why_none) {
    int count = 0;
    const gpu::result status = gpu::find_device_count(&count);
    if (status != gpu::result::success) {
        gpu::forget_failure();
        why_none = message(gpu::text_of(status), " (", gpu::name_of(status), ")");
        return 0;
    }
    if (count == 0) why_none = "the driver finds no GPU";
    return count;
}

// Weak, as it is in every model's object file: the linker keeps one.
__attribute__((weak)) std::vector<device_facts> list_devices(std::string& why_none) {
    const int count = count_devices(why_none);
    std::vector<device_facts> found;
    for (int i = 0; i < count; ++i) {
        gpu::device_properties properties{};
        MYRIAD_GPU_CALL(gpu::find_properties(&properties, i));
        found.push_back({properties.name, static_cast<std::int64_t>(properties.memory_bytes),
                         properties.multiprocessors, 10 * properties.major + properties.minor});
    }
    return found;
}

__attribute__((weak)) void pin_memory(int device, void* memory, std::size_t bytes) {
    const current_device here(device);
    const gpu::result status = gpu::pin(memory, bytes);
    if (status != gpu::result::success) gpu::forget_failure();
    require(status == gpu::result::success, static_cast<double>(bytes) / 1e9,
            " GB of host memory cannot be pinned: ", gpu::text_of(status), " (", gpu::name_of(status),
            "); there may be too little of it, or someone else has pinned it: go on without pinning");
}
__attribute__((weak)) void unpin_memory(void* memory) {
    gpu::unpin(memory);
    gpu::forget_failure();  // CUDA may be gone at exit
}

/// Throws `error` unless the device of the options exists.
inline void require_device(const engine_options& options) {
    std::string why_none;
    const int count = count_devices(why_none);
    require(count > 0, "device \"cuda:", options.device, "\" is not available: ", why_none,
            "; use \"cpu\" or \"auto\"");
    require(options.device >= 0 && options.device < count, "device \"cuda:", options.device,
            "\" does not exist: this machine has ", count, " (numbered from 0)");
}

}  // namespace myriad::cuda
