// SPDX-License-Identifier: MIT
// The CUDA kernel: one thread takes one instance through the loop. What varies is only where the threads find the
// parameters that all instances share.
#pragma once

#include <cstdint>

#include "myriad/integrator/integrate.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// A supply of one instance, the thread's own.
class own_instance {
public:
    MYRIAD_FUNCTION explicit own_instance(std::int64_t index) : index_(index) {}

    MYRIAD_FUNCTION std::int64_t next() {
        const std::int64_t given = index_;
        index_ = -1;
        return given;
    }

private:
    std::int64_t index_;
};

template <class Model, class R>
inline constexpr int shared_parameter_bytes =
    n_shared<Model>* static_cast<int>(sizeof(R)) + n_shared_integer<Model>* static_cast<int>(sizeof(std::int32_t));

/// Most threads per block; a model may choose by `static constexpr int max_block_size = 512;`. Up to 256, a thread can have
/// as many registers as the hardware addresses.
template <class Model>
constexpr int max_block_size() {
    if constexpr (requires { Model::max_block_size; }) {
        return Model::max_block_size;
    } else {
        return 256;
    }
}

/// What a kernel is launched with. In the constant bank, the shared parameters travel with the arguments.
template <class Model, class R, shared_placement placement>
struct launch_arguments {
    kernel_arguments<Model, R> ensemble;
};
template <class Model, class R>
struct launch_arguments<Model, R, shared_placement::constant_bank> {
    kernel_arguments<Model, R> ensemble;
    R shared[at_least_one(n_shared<Model>)];
    std::int32_t shared_integer[at_least_one(n_shared_integer<Model>)];
};

/// Copies the shared parameters to the block's shared memory, with all its threads.
template <class Model, class R>
__device__ __forceinline__ shared_parameters<R> stage_shared(const shared_parameters<R>& from) {
    extern __shared__ double staged[];  // double: aligned for either real type
    R* const real = reinterpret_cast<R*>(staged);
    auto* const integer = reinterpret_cast<std::int32_t*>(real + n_shared<Model>);
    for (int i = static_cast<int>(threadIdx.x); i < n_shared<Model>; i += static_cast<int>(blockDim.x))
        real[i] = from.real[i];
    for (int i = static_cast<int>(threadIdx.x); i < n_shared_integer<Model>; i += static_cast<int>(blockDim.x))
        integer[i] = from.integer[i];
    __syncthreads();
    return {real, integer};
}

/// Integrates instance `blockIdx.x * blockDim.x + threadIdx.x`.
template <class Model, class Method, class R, shared_placement placement>
__global__ void __launch_bounds__(max_block_size<Model>())
    integrate_ensemble(const __grid_constant__ launch_arguments<Model, R, placement> arguments) {
    shared_parameters<R> shared = arguments.ensemble.shared;
    if constexpr (placement == shared_placement::constant_bank) shared = {arguments.shared, arguments.shared_integer};
    if constexpr (placement == shared_placement::shared_memory) shared = stage_shared<Model, R>(shared);
    const std::int64_t index = static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;
    if (index >= arguments.ensemble.size) return;
    own_instance instance(index);
    integrate<Model, Method, R>(arguments.ensemble, shared, instance);
}

}  // namespace myriad::inline MYRIAD_TARGET
