// SPDX-License-Identifier: MIT
// MYRIAD_CUDA(call): checks a CUDA call; the error it throws names the call, the problem and a remedy.
#pragma once

#include <cuda_runtime.h>

#include "myriad/host/core/error.hpp"

/// Runs a call of the CUDA runtime; throws myriad::error unless it succeeds.
#define MYRIAD_CUDA(call) ::myriad::cuda::check((call), #call)

namespace myriad::cuda {

inline host::message_part advice_for(cudaError_t status) {
    switch (status) {
        case cudaErrorNoDevice:
        case cudaErrorInsufficientDriver:
        case cudaErrorInitializationError:
            return "check the driver with nvidia-smi, or use the device \"cpu\"";
        case cudaErrorMemoryAllocation:
            return host::cures::fewer_instances;
        case cudaErrorNoKernelImageForDevice:
        case cudaErrorInvalidDeviceFunction:
        case cudaErrorUnsupportedPtxVersion:
            return "the program has no code for this GPU: build it with -DMYRIAD_CUDA_ARCHITECTURES=native";
        case cudaErrorLaunchOutOfResources:
            return "the kernel needs more registers than a block of that size has: give a smaller options::block_size";
        case cudaErrorIllegalAddress:
        case cudaErrorMisalignedAddress:
        case cudaErrorLaunchFailure:
        case cudaErrorIllegalInstruction:
            return "a hook of the model probably reads or writes out of bounds: run the program under "
                   "compute-sanitizer; the "
                   "process cannot use this GPU any more";
        case cudaErrorLaunchTimeout:
            return "the GPU also drives a display, which limits a kernel's time: integrate fewer phases per call";
        default:
            return "run the program under compute-sanitizer for more";
    }
}

inline void check(cudaError_t status, const char* call) {
    if (status == cudaSuccess) return;
    cudaGetLastError();  // so that the next call does not report this error, if non-sticky, again
    const statement text = statement_of(call, " failed: ", cudaGetErrorString(status), " (", cudaGetErrorName(status),
                                        ')', host::cure, advice_for(status));
    if (status == cudaErrorMemoryAllocation) throw out_of_memory(text);
    throw error(text);
}

}  // namespace myriad::cuda
