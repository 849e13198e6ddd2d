// SPDX-License-Identifier: MIT
// The keys of the rounds of Philox4x32-10, as the host gives them to kernels.
#pragma once

#include <cstdint>

#include "myriad/kernel/core/macros.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The two words of a key for each round, which a GPU's instructions read as operands (model/random.hpp has the
/// source).
struct philox_keys {
    static constexpr int rounds = 10;
    std::uint32_t of_round[rounds][2];

    philox_keys() = default;
    MYRIAD_FUNCTION philox_keys(std::uint32_t key_0, std::uint32_t key_1) : of_round{} {
        MYRIAD_UNROLL
        for (int r = 0; r < rounds; ++r) {
            of_round[r][0] = key_0;
            of_round[r][1] = key_1;
            key_0 += 0x9e3779b9;
            key_1 += 0xbb67ae85;
        }
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
