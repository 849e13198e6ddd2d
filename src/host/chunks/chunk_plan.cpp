// SPDX-License-Identifier: MIT
// Sizes of chunks.
#include "myriad/host/chunks/chunk_plan.hpp"

#include <algorithm>

namespace myriad::host::inline MYRIAD_ABI {

void chunk_plan::cut(const options& o, const cuda::any_engine& worker, std::int64_t copied) {
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

chunk_plan::chunk_plan(const std::vector<chunk_plan>& alone) : chunk_plan(alone.front()) {
    if (alone.size() == 1) return;
    constexpr std::int64_t worthwhile = worth_chunks / 2, most = 8;
    const auto gpus = static_cast<std::int64_t>(alone.size());
    const std::int64_t chunks = gpus * std::clamp<std::int64_t>(size_ / (gpus * worthwhile), 1, most);
    largest_ = (size_ + chunks - 1) / chunks;
    for (const chunk_plan& plan : alone) largest_ = std::min(largest_, plan.largest_);
    smallest_ = largest_;
    at_a_time_ = std::clamp<std::int64_t>(size_ / (gpus * largest_), 1, chunks_at_a_time);
}

std::int64_t chunk_plan::count_from(std::int64_t first) const {
    const std::int64_t left = size_ - first;
    const std::int64_t count = std::min(left, std::clamp(std::min(first, left / 2), smallest_, largest_));
    return left - count < smallest_ && left <= largest_ ? left : count;
}

}  // namespace myriad::host::inline MYRIAD_ABI
