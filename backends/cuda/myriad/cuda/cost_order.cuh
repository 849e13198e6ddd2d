// SPDX-License-Identifier: MIT
// Sorts instances by cost on the GPU, without the host.
#pragma once

#include <cstdint>

#include "myriad/cuda/check.cuh"
#include "myriad/cuda/resources.cuh"
#include "myriad/kernel/core/cost_bucket.hpp"

namespace myriad::cuda {

/// The kernels of cuda/cost_order_kernels.cuh.
struct cost_kernels {
    const void *count_all_costs, *sum_costs, *place_by_cost;
};

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
    void clear(std::int64_t count, gpu::stream_handle where) {
        MYRIAD_GPU_CALL(gpu::fill(cost_.data(), 0, static_cast<std::size_t>(count) * sizeof(std::uint32_t), where));
    }
    std::uint32_t* cost() const { return static_cast<std::uint32_t*>(cost_.data()); }
    const std::uint32_t* order() const { return static_cast<const std::uint32_t*>(order_.data()); }

    /// Enqueues the sort; the instances' costs must be known.
    void sort(const cost_kernels& with, std::int64_t count, gpu::stream_handle where) {
        const auto size = static_cast<std::uint32_t>(count);
        const unsigned blocks = (size + costs_per_block - 1) / costs_per_block;
        auto* const buckets = static_cast<unsigned*>(buckets_.data());
        MYRIAD_GPU_CALL(gpu::fill(buckets, 0, cost_buckets * sizeof(unsigned), where));
        const std::uint32_t* const costs = cost();
        auto* order = static_cast<std::uint32_t*>(order_.data());
        run(with.count_all_costs, blocks, where, costs, size, buckets);
        run(with.sum_costs, 1, where, buckets);
        run(with.place_by_cost, blocks, where, costs, size, buckets, order);
    }

private:
    template <class... Arguments>
    static void run(const void* kernel, unsigned blocks, gpu::stream_handle where, Arguments... arguments) {
        void* all[] = {const_cast<void*>(static_cast<const void*>(&arguments))...};
        check(gpu::launch(kernel, {blocks}, cost_block, all, 0, where), "the launch of a sort by cost");
    }

    device_memory cost_, order_, buckets_;
};

}  // namespace myriad::cuda
