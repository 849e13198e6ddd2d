// SPDX-License-Identifier: MIT
// MYRIAD_GPU_CALL(call): checks a CUDA call; the error it throws names the call, the problem and a remedy.
#pragma once

#include "myriad/gpu/runtime.hpp"
#include "myriad/host/core/error.hpp"

/// Runs a call of the CUDA runtime; throws myriad::error unless it succeeds.
#define MYRIAD_GPU_CALL(call) ::myriad::cuda::check((call), #call)

namespace myriad::cuda {

inline host::message_part advice_for(gpu::result status) {
    switch (status) {
        case gpu::result::no_device:
        case gpu::result::insufficient_driver:
        case gpu::result::not_initialised:
            return "check the driver with nvidia-smi, or use the device \"cpu\"";
        case gpu::result::out_of_memory:
            return host::cures::fewer_instances;
        case gpu::result::no_code_for_device:
        case gpu::result::invalid_device_function:
        case gpu::result::unsupported_ptx_version:
            return "the program has no code for this GPU: build it with -DMYRIAD_CUDA_ARCHITECTURES=native";
        case gpu::result::launch_out_of_resources:
            return "the kernel needs more registers than a block of that size has: give a smaller options::block_size";
        case gpu::result::illegal_address:
        case gpu::result::misaligned_address:
        case gpu::result::launch_failure:
        case gpu::result::illegal_instruction:
            return "a hook of the model probably reads or writes out of bounds: run the program under "
                   "compute-sanitizer; the "
                   "process cannot use this GPU any more";
        case gpu::result::launch_timeout:
            return "the GPU also drives a display, which limits a kernel's time: integrate fewer phases per call";
        default:
            return "run the program under compute-sanitizer for more";
    }
}

inline void check(gpu::result status, const char* call) {
    if (status == gpu::result::success) return;
    gpu::forget_failure();  // so that the next call does not report this error, if non-sticky, again
    const statement text = statement_of(call, " failed: ", gpu::text_of(status), " (", gpu::name_of(status), ')',
                                        host::cure, advice_for(status));
    if (status == gpu::result::out_of_memory) throw out_of_memory(text);
    throw error(text);
}

}  // namespace myriad::cuda
