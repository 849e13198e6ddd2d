// SPDX-License-Identifier: MIT
// The kernel that lets a model set the instances of a study.
#pragma once

#include <cstdint>

#include "myriad/kernel/study/generator.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

__device__ __forceinline__ void mark_invalid(std::uint8_t* ended, status* how, std::int64_t i) {
    ended[i] = 1;
    how[i] = status::invalid_input;
}
__device__ __forceinline__ std::int64_t thread_number() {
    return static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;
}
__device__ __forceinline__ std::int64_t all_threads() { return static_cast<std::int64_t>(gridDim.x) * blockDim.x; }

/// Calls the model's `generate` for all instances of a chunk.
template <class Model, class R>
__device__ __forceinline__ void generate_all(const instance_arrays<array_pointer, R>& arrays,
                                             const instance_range& range, const shared_parameters<R>& shared,
                                             std::uint64_t seed) {
    for (std::int64_t i = thread_number(); i < range.size; i += all_threads())
        if (!detail::generate_instance<Model, R>(arrays, range, shared, seed, i))
            mark_invalid(arrays.ended, arrays.status, i);
}
template <class Model, class R>
__global__ void generate_instances(const instance_arrays<array_pointer, R> arrays, const instance_range range,
                                   const shared_parameters<R> shared, const std::uint64_t seed) {
    detail::generate_all<Model, R>(arrays, range, shared, seed);
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
