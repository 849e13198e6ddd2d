// SPDX-License-Identifier: MIT
// Reduces values, and partial results.
#include "study_reductions.hpp"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <mutex>
#include <span>

#include "myriad/host/threads/parallel.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

std::vector<double> reduced_on_host(const reduction_plan& plan, const chunk_range& range,
                                    const std::vector<chunk_columns::column>& all) {
    const auto state = plan.start();
    if (!plan.on_device) {
        state->add(chunk_columns(range.first, range.count, all));
        return state->partial();
    }
    std::mutex mutex;
    std::exception_ptr failure;
    host::in_parallel(range.count, 65'536, [&](std::int64_t begin, std::int64_t end) {
        try {
            std::vector<chunk_columns::column> mine(all);
            for (chunk_columns::column& c : mine) {
                const std::size_t each = c.bytes.size() / static_cast<std::size_t>(range.count);
                c.bytes = c.bytes.subspan(static_cast<std::size_t>(begin) * each,
                                          static_cast<std::size_t>(end - begin) * each);
            }
            const auto part = plan.start();
            part->add(chunk_columns(range.first + begin, end - begin, mine));
            const std::lock_guard lock(mutex);
            state->add(std::span<const double>(part->partial()));
        } catch (...) {
            const std::lock_guard lock(mutex);
            failure = std::current_exception();
        }
    });
    if (failure) std::rethrow_exception(failure);
    return state->partial();
}

void finish_reductions(const study_plan& plan, result_keeper& keeper) {
    const auto kept = keeper.kept();
    for (std::size_t r = 0; r < plan.reductions.size(); ++r) {
        const reduction_plan& reduced = plan.reductions[r];
        const auto is_written = [&](const variable& v) { return kept->written(v.name); };
        if (std::all_of(reduced.results.begin(), reduced.results.end(), is_written)) continue;
        const auto state = reduced.start();
        std::vector<double> partial(static_cast<std::size_t>(reduced.partial_size));
        for (std::int64_t c = 0; c < keeper.content().chunks(); ++c) {
            kept->read(partial_name(plan.asked.reductions[r]), c, 1, partial.data());
            state->add(std::span<const double>(partial));
        }
        const auto values = state->results();
        for (std::size_t v = 0; v < values.size(); ++v) {
            const variable& is = reduced.results[v];
            if (is.type == element::i64) {
                keeper.write(column_of(is.name, std::vector<std::int64_t>(values[v].begin(), values[v].end())));
            } else {
                keeper.write(column_of(is.name, values[v]));
            }
        }
    }
}

}  // namespace myriad::studies::inline MYRIAD_ABI
