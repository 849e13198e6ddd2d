// SPDX-License-Identifier: MIT
// The order of instances by cost, by counting how many are in each bucket. Host code only.
#pragma once

#include <cstdint>
#include <vector>

#include "myriad/kernel/core/cost_bucket.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The first `count` instances, the most expensive first; within a bucket by index.
inline std::vector<std::uint32_t> order_by_cost(const std::uint32_t* cost, std::int64_t count) {
    std::vector<std::int64_t> next(cost_buckets + 1, 0);
    for (std::int64_t i = 0; i < count; ++i) ++next[static_cast<std::size_t>(cost_bucket(cost[i])) + 1];
    for (std::size_t b = 1; b < next.size(); ++b) next[b] += next[b - 1];
    std::vector<std::uint32_t> order(static_cast<std::size_t>(count));
    for (std::int64_t i = 0; i < count; ++i)
        order[static_cast<std::size_t>(next[static_cast<std::size_t>(cost_bucket(cost[i]))]++)] =
            static_cast<std::uint32_t>(i);
    return order;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
