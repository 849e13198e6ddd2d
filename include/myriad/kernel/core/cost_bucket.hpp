// SPDX-License-Identifier: MIT
// Sorting by cost: costs are put into buckets three per cent apart, accurate enough for a prediction, so that both
// backends can counting-sort them in one pass.
#pragma once

#include <cstdint>

#include "myriad/kernel/core/macros.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

inline constexpr int cost_buckets = 1024;
/// Most instances that can be sorted: their indices have 32 bits. Larger ensembles are scheduled dynamically.
inline constexpr std::int64_t most_sorted = 2'000'000'000;
/// Threads of a CUDA block that sorts, one per bucket, and the costs that it reads.
inline constexpr int cost_block = cost_buckets, costs_per_block = 8 * cost_block;

/// The bucket for a number of steps, the most expensive first: 32 per octave; zero steps go into the last one.
MYRIAD_FUNCTION int cost_bucket(std::uint32_t cost) {
    // a float's exponent and the first five bits of its fraction; for 1 that is 127 * 32
    const int bits = static_cast<int>(__builtin_bit_cast(std::uint32_t, static_cast<float>(cost)) >> 18) - 127 * 32;
    return cost == 0 ? cost_buckets - 1 : cost_buckets - 2 - (bits < cost_buckets - 2 ? bits : cost_buckets - 2);
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
