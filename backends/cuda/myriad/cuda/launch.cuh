// SPDX-License-Identifier: MIT
// Chooses how to launch a kernel: the place of the shared parameters and the block size, from its compiled resources.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <utility>
#include <vector>

#include "myriad/cuda/check.cuh"
#include "myriad/cuda/cost_order.cuh"
#include "myriad/cuda/launch_traits.hpp"
#include "myriad/cuda/study_arguments.hpp"
#include "myriad/host/backend/backend.hpp"

namespace myriad::cuda {

/// The kernels of one model, method and real type, compiled into the program or loaded.
struct model_kernels {
    kernel_traits traits;
    const void* integrate;         // with the shared parameters in the constant bank or the cache
    const void* integrate_staged;  // in shared memory
    cost_kernels sort;
    std::function<study_kernels()> study;
};

/// Launches them on the current device.
template <class R>
class kernel_launcher {
    using place = shared_placement;

public:
    kernel_launcher(int device, const engine_options& wanted, model_kernels kernels)
        : kernels_(std::move(kernels)), offsets_(kernels_.traits.model) {
        int limit = 0;
        MYRIAD_GPU_CALL(gpu::find_attribute(&limit, gpu::device_attribute::shared_bytes_of_block, device));
        facts_.threads_per_instance = traits().team;
        const int bytes = traits().shared_bytes;
        const bool fits = bytes + traits().block_bytes + smallest_block() * traits().step_bytes <= limit;
        facts_.shared_placement = wanted.shared_placement;
        if (wanted.shared_placement == place::automatic)
            facts_.shared_placement = is_compiled(place::constant_bank, bytes) ? place::constant_bank
                                      : fits                                   ? place::shared_memory
                                                                               : place::cache;
        require(facts_.shared_placement != place::shared_memory || fits, "the model's shared parameters take ", bytes,
                " bytes, but a block of this GPU has at most ", limit, " of shared memory", host::cure,
                "set shared_placement to automatic or cache");
        require(is_compiled(facts_.shared_placement, bytes), "shared_placement is ", name_of(facts_.shared_placement),
                ", but the model's shared parameters take ", bytes,
                " bytes: up to 1024 they are kept in the constant bank, more in "
                "shared memory or the cache; set it to automatic");
        parameters_.resize(static_cast<std::size_t>(offsets_.bytes(facts_.shared_placement)) / sizeof(double));
        if (uses_shared_memory()) MYRIAD_GPU_CALL(gpu::allow_shared_bytes(function(), limit));
        choose_block(device, static_cast<int>(wanted.block_size));
    }

    const kernel_facts& facts() const { return facts_; }
    const kernel_traits& traits() const { return kernels_.traits; }
    const cost_kernels& sort() const { return kernels_.sort; }
    study_kernels study() const { return kernels_.study(); }
    /// Number of instances that gives every warp scheduler of the GPU one warp.
    std::int64_t least_instances() const { return std::int64_t{4 * warp} * multiprocessors_ / traits().team; }
    /// Whether so many instances have to wait for threads with steps in shared memory, which few threads fill, and
    /// whose steps take long.
    bool makes_wait(std::int64_t size) const {
        return keeps_steps_in_shared_memory() && traits().team == 1 &&
               size > std::int64_t{blocks_at_once(chosen_block_)} * chosen_block_;
    }
    void note(schedule how) { facts_.schedule = how; }
    /// Has later launches read there whether to stop.
    void listen_to(const std::uint32_t* stop) { stop_ = stop; }

    /// Stores the shared parameters for launches from the constant bank; `shared` is on the host.
    void set_shared(const shared_parameters<R>& shared) {
        if (facts_.shared_placement != place::constant_bank) return;
        put(offsets_.shared(), shared.real, traits().model.n_shared);
        put(offsets_.shared_integer, shared.integer, traits().model.n_shared_integer);
    }

    /// Launches the kernel on device pointers. With a queue, which must be zero, launches no more threads than run at
    /// once.
    void launch(const any_arguments<R>& arguments, unsigned long long* queue, gpu::stream_handle where) {
        const int block = facts_.block_size = block_for(arguments.size);
        auto blocks = static_cast<unsigned>((arguments.size * traits().team + block - 1) / block);
        if (queue != nullptr) blocks = std::min(blocks, blocks_at_once(block));
        facts_.shared_bytes = shared_bytes_of(block);
        divide_cache(static_cast<int>(blocks), block);
        put(0, static_cast<const argument_head<R>*>(&arguments), 1);
        put(offsets_.arrays, arguments.arrays, arguments.offsets().end);
        put(offsets_.queue, &queue, 1);
        put(offsets_.stop(), &stop_, 1);
        void* all[] = {parameters_.data()};
        check(gpu::launch(function(), {blocks}, static_cast<unsigned>(block), all,
                          static_cast<std::size_t>(facts_.shared_bytes), where),
              "the launch of the integration kernel");
    }

private:
    static constexpr int warp = gpu::warp_size;
    static constexpr std::int64_t cache_bytes = 128 * 1024;  // of a V100; later GPUs have more
    /// Of kernels with steps in shared memory: parts of a warp, unless teams share it out.
    int smallest_block() const { return traits().team > 1 ? std::max(traits().team, warp) : 8; }
    /// Whether each block is one team.
    bool team_is_block() const { return traits().team > warp; }

    const void* function() const {
        return facts_.shared_placement == place::shared_memory ? kernels_.integrate_staged : kernels_.integrate;
    }
    bool keeps_steps_in_shared_memory() const { return traits().step_bytes > 0; }
    bool uses_shared_memory() const {
        return facts_.shared_placement == place::shared_memory || keeps_steps_in_shared_memory();
    }
    int shared_bytes_of(int block) const {
        const int parameters = facts_.shared_placement == place::shared_memory ? traits().shared_bytes : 0;
        return traits().block_bytes + block * traits().step_bytes + parameters;
    }
    /// Writes values to a place of the launch parameters.
    template <class T>
    void put(int offset, const T* values, int count) {
        auto* const bytes = reinterpret_cast<std::byte*>(parameters_.data());
        if (count > 0) std::memcpy(bytes + offset, values, static_cast<std::size_t>(count) * sizeof(T));
    }

    void choose_block(int device, int wanted) {
        gpu::kernel_attributes attributes{};
        MYRIAD_GPU_CALL(gpu::find_attributes(&attributes, function()));
        facts_.registers = attributes.registers;
        facts_.local_bytes = static_cast<std::int64_t>(attributes.local_bytes);
        const int most = attributes.most_threads;
        require(wanted == 0 || !team_is_block() || wanted == traits().team, "block_size is ", wanted,
                ", but a block of this kernel is a team of ", traits().team, " threads", host::cure,
                "leave block_size out");
        require(wanted <= most, "block_size is ", wanted, ", but a block of this kernel has at most ", most,
                " threads (", attributes.registers, " registers each)", host::cure, "give a smaller block_size",
                wanted <= 1024 && traits().max_block_size < wanted
                    ? ", or let the model declare a larger `static constexpr int max_block_size`"
                    : "");
        // The smallest block size among those that keep most threads resident, as the fewer threads end together, the
        // sooner others start. Where shared memory has no room for a warp, blocks are parts of one.
        int first = std::min(warp, most / warp * warp);
        if (team_is_block()) first = traits().team;
        if (wanted > 0) first = wanted;
        consider_blocks(first, wanted > 0 ? wanted : most);
        if (traits().team > 1 && wanted == 0) consider_blocks(most / warp * warp, most);
        while (facts_.block_size == 0 && wanted == 0 && keeps_steps_in_shared_memory() && first > smallest_block()) {
            first /= 2;
            consider_blocks(first, first);
        }
        require(facts_.block_size > 0,
                "not one block of this kernel fits into a multiprocessor: ", attributes.registers,
                " registers per thread and ", shared_bytes_of(wanted > 0 ? wanted : first),
                " bytes of shared memory per block", wanted > 0 ? ": give a smaller block_size" : "");
        facts_.shared_bytes = shared_bytes_of(chosen_block_);
        MYRIAD_GPU_CALL(gpu::find_attribute(&multiprocessors_, gpu::device_attribute::multiprocessors, device));
        MYRIAD_GPU_CALL(
            gpu::find_attribute(&shared_memory_, gpu::device_attribute::shared_bytes_of_multiprocessor, device));
        chosen_by_user_ = wanted > 0;
    }

    /// Takes the smallest of these block sizes, each twice the one before, that keeps more threads resident.
    void consider_blocks(int first, int last) {
        int best_threads = facts_.blocks_per_multiprocessor * chosen_block_;
        for (int block = first; block <= last; block *= 2) {
            int blocks = 0;
            MYRIAD_GPU_CALL(gpu::find_resident_blocks(&blocks, function(), block,
                                                      static_cast<std::size_t>(shared_bytes_of(block))));
            if (blocks * block <= best_threads) continue;
            best_threads = blocks * block;
            chosen_block_ = facts_.block_size = block;
            facts_.blocks_per_multiprocessor = blocks;
        }
    }
    /// A multiprocessor's share of the threads, a multiple of a warp's.
    int even_block(std::int64_t size) const {
        const std::int64_t warps = (size * traits().team + warp - 1) / warp;
        return static_cast<int>((warps + multiprocessors_ - 1) / multiprocessors_) * warp;
    }

    int resident_blocks(int block) const {
        return std::max(facts_.blocks_per_multiprocessor * chosen_block_ / block, 1);
    }
    unsigned blocks_at_once(int block) const {
        return static_cast<unsigned>(resident_blocks(block) * multiprocessors_);
    }

    /// Shared memory and the cache of local memory are one: asks for as much shared memory as the blocks of a launch
    /// use at a time. Else the cache would be as small as for a launch that fills the GPU.
    void divide_cache(int blocks, int block) {
        if (!keeps_steps_in_shared_memory()) return;
        constexpr std::int64_t reserved = 1024;  // for each block
        const int resident = std::min((blocks + multiprocessors_ - 1) / multiprocessors_, resident_blocks(block));
        const std::int64_t used = resident * (shared_bytes_of(block) + reserved);
        const auto percent =
            static_cast<int>(std::min<std::int64_t>((100 * used + shared_memory_ - 1) / shared_memory_, 100));
        MYRIAD_GPU_CALL(gpu::prefer_shared_memory(function(), percent));
    }

    /// Ensembles too small to fill the GPU are spread over all its multiprocessors, down to one warp per block. With
    /// still fewer instances than warps have threads, a warp gets only some of its threads to run, as long as each has
    /// a scheduler for itself: then fewer threads wait for what only one of them does. Steps in shared memory are
    /// spread over all multiprocessors alone: a second warp would only take the first one's cache.
    int block_for(std::int64_t size) const {
        int block = chosen_block_;
        if (chosen_by_user_ || team_is_block()) return block;
        // Where one block takes the shared memory of a multiprocessor, for what all its teams read, all run at once.
        if (traits().team > 1 && facts_.blocks_per_multiprocessor == 1 && even_block(size) <= block)
            return even_block(size);
        while (block > warp && size * traits().team <= static_cast<std::int64_t>(multiprocessors_) * block / 2)
            block /= 2;
        if (traits().costs_differ && traits().team == 1) {
            const std::int64_t warps = keeps_steps_in_shared_memory() ? multiprocessors_ : least_instances() / warp;
            while (block > 1 && block <= warp && size <= warps * (block / 2) && fits_the_cache(size, block / 2))
                block /= 2;
        }
        return block;
    }
    /// Whether the local memory of blocks of at most one warp stays in the cache of a multiprocessor. A warp has that
    /// of all its threads, word by word side by side, however many of them run: docs/numerics/stiff_methods.md has what
    /// that cost.
    bool fits_the_cache(std::int64_t size, std::int64_t block) const {
        if (keeps_steps_in_shared_memory()) return true;  // as closely as one warp does
        const std::int64_t blocks = (size + block - 1) / block;
        const std::int64_t resident = (blocks + multiprocessors_ - 1) / multiprocessors_;
        return resident * warp * facts_.local_bytes <= cache_bytes;
    }

    model_kernels kernels_;
    launch_offsets<R> offsets_;
    std::vector<double> parameters_;  // doubles, for their alignment
    kernel_facts facts_;
    const std::uint32_t* stop_ = nullptr;
    int multiprocessors_ = 1, shared_memory_ = 1, chosen_block_ = 0;  // shared memory of a multiprocessor, in bytes
    bool chosen_by_user_ = false;
};

}  // namespace myriad::cuda
