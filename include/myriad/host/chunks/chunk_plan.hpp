// SPDX-License-Identifier: MIT
// How `solve` cuts an ensemble into chunks for a GPU. Host code only.
#pragma once

#include <algorithm>
#include <cstdint>

#include "myriad/host/backend/arrays.hpp"
#include "myriad/host/backend/backend.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad::host {

/// Chunks in flight at a time: one is uploaded, one is integrated, one is downloaded by a separate thread.
inline constexpr std::int64_t chunks_at_a_time = 3;
/// Most chunks on the device while inputs are still being checked and none may be downloaded.
inline constexpr std::int64_t most_chunks_held = 16;
/// Ensembles of fewer instances are not split.
inline constexpr std::int64_t worth_chunks = 131'072;

class chunk_plan {
public:
    /// One chunk of all instances.
    explicit chunk_plan(std::int64_t size) : size_(size), largest_(size), smallest_(size) {}
    /// As the options say, or enough chunks to overlap most of the transfers, each large enough to keep the GPU and the
    /// bus busy.
    template <class Model, class R>
    chunk_plan(const options& o, kernel_arguments<Model, R>& arguments, const cuda::engine<Model, R>& worker)
        : chunk_plan(arguments.size) {
        std::int64_t copied = 0;
        const auto add = [&](auto* array, std::int64_t components, array_access access, array_kind) {
            const auto all = components * static_cast<std::int64_t>(sizeof(*array));
            bytes_ += all;
            copied += access == array_access::update ? 2 * all : all;
        };
        for_each_array(arguments, add);
        for_each_record(arguments.record, add);
        if (o.chunk_size > 0) {
            largest_ = smallest_ = std::min(o.chunk_size, size_);
            at_a_time_ = std::min((size_ - 1) / largest_ + 1, chunks_at_a_time);
            return;
        }
        constexpr std::int64_t most_chunks = 32, worthwhile_bytes = std::int64_t{8} << 20,
                               all_memory_has = std::int64_t{64} << 20;
        const std::int64_t least = std::max({worth_chunks, worker.full_load(), worthwhile_bytes / copied});
        const std::int64_t chunks = std::clamp(size_ / least, std::int64_t{1}, most_chunks);
        largest_ = (size_ + chunks - 1) / chunks;
        const std::int64_t held = largest_ * (has_one_chunk() ? 1 : chunks_at_a_time);
        if (held * bytes_ > all_memory_has) {
            const std::int64_t fits = worker.affordable(bytes_);
            if (fits < held) largest_ = std::clamp(fits / chunks_at_a_time, std::int64_t{1}, largest_);
        }
        if (has_one_chunk()) return;
        smallest_ = std::max(largest_ / 4, std::int64_t{1});
        at_a_time_ = chunks_at_a_time;
    }

    bool has_one_chunk() const { return largest_ == size_; }
    /// Chunks to have in flight at a time.
    std::int64_t at_a_time() const { return at_a_time_; }
    /// Instances of the largest chunk, and how many bytes each has.
    std::int64_t largest() const { return largest_; }
    std::int64_t bytes_per_instance() const { return bytes_; }
    /// Number of instances in the chunk that begins at `first`. The first chunks are smaller, so that the GPU starts
    /// early, and so are the last ones, so that little is left to download when it finishes.
    std::int64_t count_from(std::int64_t first) const {
        const std::int64_t left = size_ - first;
        const std::int64_t count = std::min(left, std::clamp(std::min(first, left / 2), smallest_, largest_));
        return left - count < smallest_ && left <= largest_ ? left : count;
    }

private:
    std::int64_t size_, largest_, smallest_, at_a_time_ = 1, bytes_ = 0;
};

}  // namespace myriad::host
