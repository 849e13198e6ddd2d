// SPDX-License-Identifier: MIT
// What all paths of a call have in common, as the host gives it to kernels.
#pragma once

#include <cmath>
#include <cstdint>

#include "myriad/kernel/scalar/philox_keys.hpp"

namespace myriad::detail {

/// The parts into which a cell of a path is divided: the finest times at which a path has a value. Sixteen halvings, as
/// a node has 16 bits in a counter.
inline constexpr int parts_of_cell = 65536;

/// Instances that have paths of their own.
inline constexpr std::int64_t most_paths = std::int64_t{1} << 36;

template <class R>
struct path_constants {
    R cell, root;  // the length of a cell, and its square root
    philox_keys keys;
};

/// The key of a seed: a bijection, so that no two seeds have one (the last function of SplitMix64: Steele, Lea and
/// Flood, OOPSLA 2014), after a constant, so that paths share no key with the random numbers that hooks draw.
constexpr std::uint64_t key_of_paths(std::uint64_t seed) {
    std::uint64_t z = seed + 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return z ^ z >> 31;
}

/// For cells of this length.
template <class R>
path_constants<R> path_constants_of(R cell, std::uint64_t seed) {
    const std::uint64_t key = key_of_paths(seed);
    return {cell, std::sqrt(cell), philox_keys(static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32))};
}

}  // namespace myriad::detail
