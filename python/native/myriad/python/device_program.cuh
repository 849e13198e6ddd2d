// SPDX-License-Identifier: MIT
// What NVRTC compiles before a model: MYRIAD_DEVICE_PROGRAM, which makes the kernels of a model, a method and a real
// type, found by their names.
#pragma once

#include "myriad/cuda/cost_order_kernels.cuh"
#include "myriad/cuda/kernel.cuh"
#include "myriad/cuda/launch_traits.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/methods.hpp"
#include "myriad/model.hpp"
#include "myriad/python/device_layout.hpp"
#include "myriad/python/facts_of.hpp"
#include "myriad/random.hpp"
#include "myriad/tangent.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Where the launch parameters are, by way of addresses in a memory that need not hold them: not every NVRTC has
/// offsetof.
template <class Model, class R, shared_placement placement>
__device__ __forceinline__ python::argument_layout layout_of(const void* memory) {
    using arguments = launch_arguments<Model, R, placement>;
    const auto& all = *static_cast<const arguments*>(memory);
    const auto& one = all.ensemble;
    const auto at = [memory](const auto& member) {
        return static_cast<std::uint32_t>(reinterpret_cast<const char*>(&member) - static_cast<const char*>(memory));
    };
    python::argument_layout l{};
    l.head = at(one.shrink_limit) + sizeof one.shrink_limit;
    l.relative_tolerance = at(one.relative_tolerance);
    l.absolute_tolerance = at(one.absolute_tolerance);
    l.event = at(one.event);
    l.rising = at(one.rising);
    l.falling = at(one.falling);
    l.sub_samples = at(one.sub_samples);
    l.accumulation_limit = at(one.accumulation_limit);
    l.record = at(one.record);
    l.record_head = at(one.record.time_column) + sizeof one.record.time_column - l.record;
    l.record_columns[0] = at(one.record.state_column);
    l.record_columns[1] = at(one.record.accessory_column);
    l.record_columns[2] = at(one.record.integer_accessory_column);
    l.sample = at(one.sample);
    l.sample_head = at(one.sample.minimum_spacing) + sizeof one.sample.minimum_spacing - l.sample;
    l.sample_columns = at(one.sample.column);
    l.queue = at(all.queue);
    l.stop = at(all.stop);
    if constexpr (placement == shared_placement::constant_bank) {
        l.shared = at(all.shared);
        l.shared_integer = at(all.shared_integer);
    }
    l.size = sizeof all;
    return l;
}

template <class Model>
inline constexpr int most_threads = max_block_size<Model>();

template <class Model, class Method, class R, shared_placement placement>
__device__ __forceinline__ void tell_facts(python::device_facts* to) {
    *to = {
        .model = facts_of<Model, Method, R>,
        .layout = layout_of<Model, R, placement>(to),
        .shared_placement = placement,
        .shared_bytes = shared_parameter_bytes<Model, R>,
        .max_block_size = most_threads<Model>,
        .costs_differ = costs_differ<Model, Method>,
    };
}

/// Adds up the values of a warp's threads; its first thread has the sum.
__device__ __forceinline__ unsigned long long sum_of_warp(unsigned long long value) {
    for (int distance = 16; distance > 0; distance /= 2) value += __shfl_down_sync(0xffffffff, value, distance);
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
    if (threadIdx.x % 32 == 0) atomicAdd(sum, own);
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
    extern "C" __global__ void __launch_bounds__(myriad::detail::max_block_size<Model>()) myriad_integrate(            \
        const __grid_constant__ myriad::detail::launch_arguments<Model, R, myriad::shared_placement::place>            \
            arguments) {                                                                                               \
        myriad::detail::integrate_thread<Model, Method, R, myriad::shared_placement::place>(arguments);                \
    }
