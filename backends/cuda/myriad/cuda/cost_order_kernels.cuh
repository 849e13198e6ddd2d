// SPDX-License-Identifier: MIT
// The kernels that sort instances by cost (cuda/cost_order.cuh): histogram, prefix sums, scatter.
#pragma once

#include <cstdint>

#include "myriad/kernel/core/cost_bucket.hpp"
#include "myriad/kernel/core/macros.hpp"

// One copy for each file of a program, or, compiled at run time, one by its name.
#if defined(MYRIAD_COMPILED_AT_RUN_TIME)
#define MYRIAD_GLOBAL extern "C" __global__
#else
#define MYRIAD_GLOBAL static __global__
#endif

namespace myriad::detail::inline MYRIAD_TARGET {

/// Counts this block's costs in shared memory; synchronises the block at the start and at the end.
__device__ __forceinline__ void count_costs(const std::uint32_t* cost, std::uint32_t size, unsigned* counted) {
    counted[threadIdx.x] = 0;
    __syncthreads();
    const std::uint32_t first = blockIdx.x * costs_per_block;
    for (std::uint32_t i = first + threadIdx.x; i < first + costs_per_block && i < size; i += cost_block)
        atomicAdd(&counted[cost_bucket(cost[i])], 1u);
    __syncthreads();
}

MYRIAD_GLOBAL void __launch_bounds__(cost_block)
    count_all_costs(const std::uint32_t* cost, std::uint32_t size, unsigned* total) {
    __shared__ unsigned counted[cost_buckets];
    detail::count_costs(cost, size, counted);
    if (counted[threadIdx.x] > 0) atomicAdd(&total[threadIdx.x], counted[threadIdx.x]);
}

/// The start of each bucket, from the bucket sizes; one block.
MYRIAD_GLOBAL void __launch_bounds__(cost_block) sum_costs(unsigned* total) {
    __shared__ unsigned sum[cost_buckets];
    const unsigned own = total[threadIdx.x];
    sum[threadIdx.x] = own;
    __syncthreads();
    for (unsigned reach = 1; reach < cost_buckets; reach *= 2) {
        const unsigned left = threadIdx.x >= reach ? sum[threadIdx.x - reach] : 0;
        __syncthreads();
        sum[threadIdx.x] += left;
        __syncthreads();
    }
    total[threadIdx.x] = sum[threadIdx.x] - own;
}

/// Each block reserves its share of a bucket at once, so that neighbours stay close together.
MYRIAD_GLOBAL void __launch_bounds__(cost_block)
    place_by_cost(const std::uint32_t* cost, std::uint32_t size, unsigned* begin, std::uint32_t* order) {
    __shared__ unsigned place[cost_buckets];
    detail::count_costs(cost, size, place);
    if (place[threadIdx.x] > 0) place[threadIdx.x] = atomicAdd(&begin[threadIdx.x], place[threadIdx.x]);
    __syncthreads();
    const std::uint32_t first = blockIdx.x * costs_per_block;
    for (std::uint32_t i = first + threadIdx.x; i < first + costs_per_block && i < size; i += cost_block)
        order[atomicAdd(&place[cost_bucket(cost[i])], 1u)] = i;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
