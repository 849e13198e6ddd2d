// SPDX-License-Identifier: MIT
// Sorts instances by cost on the GPU, without the host: histogram, prefix sums, scatter.
#pragma once

#include <cstdint>

#include "myriad/cuda/check.cuh"
#include "myriad/cuda/resources.cuh"
#include "myriad/kernel/core/cost_bucket.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

inline constexpr int cost_block = 1024, costs_per_block = 8 * cost_block;
static_assert(cost_buckets == cost_block, "one thread per bucket");

/// Counts this block's costs in shared memory; synchronises the block at the start and at the end.
__device__ __forceinline__ void count_costs(const std::uint32_t* cost, std::uint32_t size, unsigned* counted) {
    counted[threadIdx.x] = 0;
    __syncthreads();
    const std::uint32_t first = blockIdx.x * costs_per_block;
    for (std::uint32_t i = first + threadIdx.x; i < first + costs_per_block && i < size; i += cost_block)
        atomicAdd(&counted[cost_bucket(cost[i])], 1u);
    __syncthreads();
}

static __global__ void __launch_bounds__(cost_block)
    count_all_costs(const std::uint32_t* cost, std::uint32_t size, unsigned* total) {
    __shared__ unsigned counted[cost_buckets];
    detail::count_costs(cost, size, counted);
    if (counted[threadIdx.x] > 0) atomicAdd(&total[threadIdx.x], counted[threadIdx.x]);
}

/// The start of each bucket, from the bucket sizes; one block.
static __global__ void __launch_bounds__(cost_block) sum_costs(unsigned* total) {
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
static __global__ void __launch_bounds__(cost_block)
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

namespace myriad::cuda {

/// The costs of a chunk's instances, and their order by cost, in device memory.
class cost_order {
public:
    void reserve(std::int64_t count) {
        const auto bytes = static_cast<std::size_t>(count) * sizeof(std::uint32_t);
        cost_.reserve(bytes);
        order_.reserve(bytes);
        buckets_.reserve(cost_buckets * sizeof(unsigned));
    }
    std::size_t bytes() const { return cost_.bytes() + order_.bytes(); }
    void release() {
        cost_.release();
        order_.release();
    }
    /// Enqueues the clearing of the costs.
    void clear(std::int64_t count, cudaStream_t where) {
        MYRIAD_CUDA(cudaMemsetAsync(cost_.data(), 0, static_cast<std::size_t>(count) * sizeof(std::uint32_t), where));
    }
    std::uint32_t* cost() const { return static_cast<std::uint32_t*>(cost_.data()); }
    const std::uint32_t* order() const { return static_cast<const std::uint32_t*>(order_.data()); }

    /// Enqueues the sort; the instances' costs must be known.
    void sort(std::int64_t count, cudaStream_t where) {
        const auto size = static_cast<std::uint32_t>(count);
        const unsigned blocks = (size + costs_per_block - 1) / costs_per_block;
        auto* const buckets = static_cast<unsigned*>(buckets_.data());
        MYRIAD_CUDA(cudaMemsetAsync(buckets, 0, cost_buckets * sizeof(unsigned), where));
        const std::uint32_t* const costs = cost();
        cudaLaunchConfig_t how{};
        how.blockDim = dim3(cost_block);
        how.stream = where;
        how.gridDim = dim3(blocks);
        MYRIAD_CUDA(cudaLaunchKernelEx(&how, &count_all_costs, costs, size, buckets));
        how.gridDim = dim3(1);
        MYRIAD_CUDA(cudaLaunchKernelEx(&how, &sum_costs, buckets));
        how.gridDim = dim3(blocks);
        MYRIAD_CUDA(
            cudaLaunchKernelEx(&how, &place_by_cost, costs, size, buckets, static_cast<std::uint32_t*>(order_.data())));
    }

private:
    device_memory cost_, order_, buckets_;
};

}  // namespace myriad::cuda
