// SPDX-License-Identifier: MIT
// How `solve` cuts an ensemble into chunks for a GPU. Host code only.
#pragma once

#include <cstdint>
#include <vector>

#include "myriad/host/backend/arrays.hpp"
#include "myriad/host/backend/backend.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

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
    template <class R>
    chunk_plan(const options& o, any_arguments<R> arguments, const cuda::any_engine& worker)
        : chunk_plan(arguments.size) {
        bytes_ = detail::bytes_per_instance(arguments);
        std::int64_t back = 0;
        const auto add = [&](auto* array, std::int64_t components, array_access access, array_kind) {
            if (access == array_access::update) back += components * static_cast<std::int64_t>(sizeof(*array));
        };
        for_each_array(arguments, add);
        cut(o, worker, bytes_ + back);
    }
    /// For GPUs of which each alone would have one of those plans: chunks of the same size, as many for each as on one
    /// alone, so that the faster ones take more of them, but none too small.
    explicit chunk_plan(const std::vector<chunk_plan>& alone);

    bool has_one_chunk() const { return largest_ == size_; }
    /// Chunks to have in flight at a time.
    std::int64_t at_a_time() const { return at_a_time_; }
    /// Instances of the largest chunk, and how many bytes each has.
    std::int64_t largest() const { return largest_; }
    std::int64_t bytes_per_instance() const { return bytes_; }
    /// Number of instances in the chunk that begins at `first`. The first chunks are smaller, so that the GPU starts
    /// early, and so are the last ones, so that little is left to download when it finishes.
    std::int64_t count_from(std::int64_t first) const;

private:
    /// `copied`: bytes per instance, both ways.
    void cut(const options& o, const cuda::any_engine& worker, std::int64_t copied);

    std::int64_t size_, largest_, smallest_, at_a_time_ = 1, bytes_ = 0;
};

}  // namespace myriad::host::inline MYRIAD_ABI
