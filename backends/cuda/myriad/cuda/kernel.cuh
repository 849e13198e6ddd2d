// SPDX-License-Identifier: MIT
// The CUDA kernel: one thread takes one instance through the loop. Host launch code follows with the CUDA backend.
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

/// Integrates instance `blockIdx.x * blockDim.x + threadIdx.x`.
template <class Model, class Method, class R>
__global__ void integrate_ensemble(const __grid_constant__ kernel_arguments<Model, R> arguments) {
    const std::int64_t index = static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;
    if (index >= arguments.size) return;
    own_instance instance(index);
    integrate<Model, Method, R>(arguments, instance);
}

}  // namespace myriad::inline MYRIAD_TARGET
