// SPDX-License-Identifier: MIT
// What NVRTC compiles before a model: MYRIAD_DEVICE_PROGRAM, which makes the kernels of a model, a method and a real
// type, found by their names.
#pragma once

#include "myriad/cuda/cost_order_kernels.cuh"
#include "myriad/cuda/kernel.cuh"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/methods.hpp"
#include "myriad/model.hpp"
#include "myriad/python/device_facts.hpp"
#include "myriad/random.hpp"
#include "myriad/sensitivity.hpp"
#include "myriad/tangent.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class R, shared_placement placement>
__device__ __forceinline__ void tell_facts(python::device_facts* to) {
    *to = {compiled_facts_of<Model, Method, R>, traits_of<model_of_thread<Model, Method, R>, Method, R>, placement};
}

/// Adds up the values of a warp's threads; its first thread has the sum.
__device__ __forceinline__ unsigned long long sum_of_warp(unsigned long long value) {
    for (int distance = gpu::warp_size / 2; distance > 0; distance /= 2)
        value += gpu::shuffle_down(~gpu::lane_mask(0), value, distance);
    return value;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET

/// Adds all values to `sum`. Blocks of whole warps.
extern "C" __global__ void myriad_sum(const std::int64_t* values, std::int64_t size, unsigned long long* sum) {
    unsigned long long own = 0;
    const std::int64_t all = static_cast<std::int64_t>(gridDim.x) * blockDim.x;
    for (std::int64_t i = static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x; i < size; i += all)
        own += static_cast<unsigned long long>(values[i]);
    own = myriad::detail::sum_of_warp(own);
    if (threadIdx.x % myriad::gpu::warp_size == 0) atomicAdd(sum, own);
}

namespace myriad::detail::inline MYRIAD_TARGET {

/// Lowers `first` to the index of the first value that is not finite.
template <class R>
__device__ __forceinline__ void find_not_finite(const R* values, std::int64_t size, unsigned long long* first) {
    const std::int64_t all = static_cast<std::int64_t>(gridDim.x) * blockDim.x;
    for (std::int64_t i = static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x; i < size; i += all)
        if (!functions<R>::is_finite(values[i])) atomicMin(first, static_cast<unsigned long long>(i));
}

}  // namespace myriad::detail::inline MYRIAD_TARGET

/// Makes the kernel of a model, a method and a real type, with the model's shared parameters in the place of that name.
/// The arguments may not contain commas.
#define MYRIAD_DEVICE_PROGRAM(Model, Method, R, place)                                                                 \
    static_assert(myriad::detail::check_linkage<Model, Method>());                                                     \
    static_assert(                                                                                                     \
        myriad::cuda::is_compiled(myriad::shared_placement::place, myriad::detail::shared_parameter_bytes<Model, R>)); \
    extern "C" __global__ void myriad_tell_facts(myriad::python::device_facts* to) {                                   \
        myriad::detail::tell_facts<Model, Method, R, myriad::shared_placement::place>(to);                             \
    }                                                                                                                  \
    extern "C" __global__ void myriad_find_not_finite(const R* values, std::int64_t size, unsigned long long* first) { \
        myriad::detail::find_not_finite(values, size, first);                                                          \
    }                                                                                                                  \
    using myriad_part = myriad::detail::model_of_thread<Model, Method, R>;                                             \
    extern "C" __global__ void __launch_bounds__(myriad::detail::max_block_size<myriad_part>()) myriad_integrate(      \
        const __grid_constant__ myriad::detail::launch_arguments<myriad_part, R, myriad::shared_placement::place>      \
            arguments) {                                                                                               \
        myriad::detail::integrate_thread<myriad_part, Method, R, myriad::shared_placement::place>(arguments);          \
    }
