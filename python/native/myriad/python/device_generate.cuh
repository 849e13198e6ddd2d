// SPDX-License-Identifier: MIT
// What NVRTC compiles besides for a model that sets the instances of studies: MYRIAD_DEVICE_GENERATE, which makes the
// kernel that does so.
#pragma once

#include "myriad/cuda/generate_kernel.cuh"

/// Makes the kernel that calls a model's `generate`. The arguments may not contain commas.
#define MYRIAD_DEVICE_GENERATE(Model, R)                                                               \
    extern "C" __global__ void myriad_generate(                                                        \
        const myriad::detail::instance_arrays<myriad::detail::array_pointer, R> arrays,                \
        const myriad::detail::instance_range range, const myriad::detail::shared_parameters<R> shared, \
        const std::uint64_t seed) {                                                                    \
        myriad::detail::generate_all<Model, R>(arrays, range, shared, seed);                           \
    }
