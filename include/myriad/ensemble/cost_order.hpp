// SPDX-License-Identifier: MIT
// Sorting by cost: costs are put into buckets three per cent apart, as exact an order as a prediction deserves, so that
// counting sorts them in one pass on either backend.
#pragma once

#include <cstdint>
#include <vector>

#include "myriad/core/macros.hpp"

namespace myriad::inline MYRIAD_TARGET {

inline constexpr int cost_buckets = 1024;
/// Instances that can be sorted: their numbers take 32 bits. More are taken dynamically.
inline constexpr std::int64_t most_sorted = 2'000'000'000;

/// The bucket of a number of steps, the most expensive first: 32 to an octave, zero in the last one.
MYRIAD_FUNCTION int cost_bucket(std::uint32_t cost) {
    // a float's exponent and the first five bits of its fraction, of which 1 has 127 * 32
    const int bits = static_cast<int>(__builtin_bit_cast(std::uint32_t, static_cast<float>(cost)) >> 18) - 127 * 32;
    return cost == 0 ? cost_buckets - 1 : cost_buckets - 2 - (bits < cost_buckets - 2 ? bits : cost_buckets - 2);
}

/// The first `count` instances, the most expensive first, those of one bucket by index.
inline std::vector<std::uint32_t> order_by_cost(const std::uint32_t* cost, std::int64_t count) {
    std::vector<std::int64_t> next(cost_buckets + 1, 0);
    for (std::int64_t i = 0; i < count; ++i) ++next[static_cast<std::size_t>(cost_bucket(cost[i])) + 1];
    for (std::size_t b = 1; b < next.size(); ++b) next[b] += next[b - 1];
    std::vector<std::uint32_t> order(static_cast<std::size_t>(count));
    for (std::int64_t i = 0; i < count; ++i)
        order[static_cast<std::size_t>(next[static_cast<std::size_t>(cost_bucket(cost[i]))]++)] = static_cast<std::uint32_t>(i);
    return order;
}

}  // namespace myriad::inline MYRIAD_TARGET
