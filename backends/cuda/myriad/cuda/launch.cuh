// SPDX-License-Identifier: MIT
// Chooses how to launch a kernel: the place of the shared parameters and the block size, from its compiled resources.
#pragma once

#include <algorithm>
#include <cstring>
#include <string>

#include "myriad/cuda/check.cuh"
#include "myriad/cuda/kernel.cuh"
#include "myriad/host/backend/backend.hpp"

namespace myriad::cuda {

/// The places for which a model's kernel is compiled: the constant bank for few shared parameters, the others for many.
template <class Model, class R>
constexpr bool is_compiled(shared_placement placement) {
    constexpr bool few = shared_parameter_bytes<Model, R> <= 1024;
    return few == (placement == shared_placement::constant_bank);
}

/// Kernels of one model, method and real type on the current device.
template <class Model, class Method, class R>
class kernel_launcher {
    using place = shared_placement;
    template <place p>
    static constexpr auto* kernel = &integrate_ensemble<Model, Method, R, p>;

public:
    kernel_launcher(int device, const engine_options& wanted) {
        int limit = 0;
        MYRIAD_CUDA(cudaDeviceGetAttribute(&limit, cudaDevAttrMaxSharedMemoryPerBlockOptin, device));
        constexpr int bytes = shared_parameter_bytes<Model, R>;
        const bool fits = bytes <= limit;
        facts_.shared_placement = wanted.shared_placement;
        if (wanted.shared_placement == place::automatic)
            facts_.shared_placement = is_compiled<Model, R>(place::constant_bank) ? place::constant_bank
                                      : fits                                      ? place::shared_memory
                                                                                  : place::cache;
        require(facts_.shared_placement != place::shared_memory || fits, "the model's shared parameters take ", bytes,
                " bytes, but a block of this GPU has at most ", limit,
                " of shared memory: set shared_placement to automatic or cache");
        require(is_compiled<Model, R>(facts_.shared_placement), "shared_placement is ",
                name_of(facts_.shared_placement), ", but the model's shared parameters take ", bytes,
                " bytes: up to 1024 they are kept in the constant bank, more in "
                "shared memory or the cache; set it to automatic");
        with_kernel([&](auto* function) { choose_block(function, static_cast<int>(wanted.block_size)); });
    }

    const kernel_facts& facts() const { return facts_; }
    /// Number of threads that gives every warp scheduler of the GPU one warp.
    std::int64_t least_threads() const { return std::int64_t{128} * multiprocessors_; }
    void note(schedule how) { facts_.schedule = how; }

    /// Stores the shared parameters for launches from the constant bank; `shared` is on the host.
    void set_shared(const shared_parameters<R>& shared) {
        if constexpr (is_compiled<Model, R>(place::constant_bank)) {
            std::copy_n(shared.real, n_shared<Model>, constants_.shared);
            std::copy_n(shared.integer, n_shared_integer<Model>, constants_.shared_integer);
        }
    }

    /// Launches the kernel on device pointers. With a queue, which must be zero, launches no more threads than run at
    /// once.
    void launch(const kernel_arguments<Model, R>& arguments, unsigned long long* queue, cudaStream_t where) {
        const int block = facts_.block_size = block_for(arguments.size);
        auto blocks = static_cast<unsigned>((arguments.size + block - 1) / block);
        if (queue != nullptr) blocks = std::min(blocks, blocks_at_once(block));
        if (facts_.shared_placement == place::constant_bank) {
            if constexpr (is_compiled<Model, R>(place::constant_bank)) {
                constants_.ensemble = arguments;
                constants_.queue = queue;
                run<place::constant_bank>(constants_, blocks, block, where);
            }
        } else if constexpr (!is_compiled<Model, R>(place::constant_bank)) {
            if (facts_.shared_placement == place::shared_memory) {
                run<place::shared_memory>({arguments, queue}, blocks, block, where);
            } else {
                run<place::cache>({arguments, queue}, blocks, block, where);
            }
        }
    }

private:
    template <place p>
    void run(const launch_arguments<Model, R, p>& all, unsigned blocks, int block, cudaStream_t where) const {
        // Not <<<>>>, which returns the status of the thread's last failure, whatever its cause.
        void* arguments[] = {const_cast<launch_arguments<Model, R, p>*>(&all)};
        check(
            cudaLaunchKernel(reinterpret_cast<const void*>(kernel<p>), dim3(blocks), dim3(static_cast<unsigned>(block)),
                             arguments, static_cast<std::size_t>(facts_.shared_bytes), where),
            "the launch of the integration kernel");
    }

    /// Calls `use` with the chosen kernel.
    template <class Use>
    void with_kernel(Use&& use) {
        if constexpr (is_compiled<Model, R>(place::constant_bank)) {
            use(kernel<place::constant_bank>);
        } else if (facts_.shared_placement == place::shared_memory) {
            use(kernel<place::shared_memory>);
        } else {
            use(kernel<place::cache>);
        }
    }

    template <class Kernel>
    void choose_block(Kernel* function, int wanted) {
        const auto* const address = reinterpret_cast<const void*>(function);
        cudaFuncAttributes attributes{};
        MYRIAD_CUDA(cudaFuncGetAttributes(&attributes, address));
        facts_.registers = attributes.numRegs;
        facts_.local_bytes = static_cast<std::int64_t>(attributes.localSizeBytes);
        if (facts_.shared_placement == place::shared_memory) {
            constexpr int bytes = shared_parameter_bytes<Model, R>;
            MYRIAD_CUDA(cudaFuncSetAttribute(address, cudaFuncAttributeMaxDynamicSharedMemorySize, bytes));
            facts_.shared_bytes = bytes;
        }
        const int most = attributes.maxThreadsPerBlock;
        require(wanted <= most, "block_size is ", wanted, ", but a block of this kernel has at most ", most,
                " threads (", attributes.numRegs, " registers each): give a smaller block_size",
                wanted <= 1024 && max_block_size<Model>() < wanted
                    ? ", or let the model declare a larger `static constexpr int max_block_size`"
                    : "");
        // The smallest block size among those that keep most threads resident.
        int best_threads = 0;
        for (int block = wanted > 0 ? wanted : std::min(64, most / 32 * 32); block <= (wanted > 0 ? wanted : most);
             block *= 2) {
            int blocks = 0;
            MYRIAD_CUDA(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, function, block,
                                                                      static_cast<std::size_t>(facts_.shared_bytes)));
            if (blocks * block <= best_threads) continue;
            best_threads = blocks * block;
            chosen_block_ = facts_.block_size = block;
            facts_.blocks_per_multiprocessor = blocks;
        }
        require(facts_.block_size > 0, "not one block of this kernel fits into a multiprocessor: ", attributes.numRegs,
                " registers per thread and ", facts_.shared_bytes, " bytes of shared memory per block");
        int device = 0;
        MYRIAD_CUDA(cudaGetDevice(&device));
        MYRIAD_CUDA(cudaDeviceGetAttribute(&multiprocessors_, cudaDevAttrMultiProcessorCount, device));
        chosen_by_user_ = wanted > 0;
    }

    unsigned blocks_at_once(int block) const {
        const int per_multiprocessor = std::max(facts_.blocks_per_multiprocessor * chosen_block_ / block, 1);
        return static_cast<unsigned>(per_multiprocessor * multiprocessors_);
    }

    /// Ensembles too small to fill the GPU are spread over all its multiprocessors, down to one warp per block. With
    /// still fewer instances than warps have threads, a warp gets only some of its threads to run, as long as each has
    /// a scheduler for itself: then fewer threads wait for what only one of them does.
    int block_for(std::int64_t size) const {
        int block = chosen_block_;
        if (chosen_by_user_) return block;
        while (block > 32 && size <= static_cast<std::int64_t>(multiprocessors_) * block / 2) block /= 2;
        if constexpr (costs_differ<Model, Method>) {
            const std::int64_t schedulers = least_threads() / 32;
            while (block > 1 && block <= 32 && size <= schedulers * (block / 2)) block /= 2;
        }
        return block;
    }

    kernel_facts facts_;
    launch_arguments<Model, R, is_compiled<Model, R>(place::constant_bank) ? place::constant_bank : place::cache>
        constants_{};
    int multiprocessors_ = 1, chosen_block_ = 0;
    bool chosen_by_user_ = false;
};

}  // namespace myriad::cuda
