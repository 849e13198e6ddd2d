// SPDX-License-Identifier: MIT
// Sums without rounding errors, so that a sum depends neither on the order nor on how the numbers were divided among
// chunks and devices. Host code only.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/study/reduced_values.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// The exact sum of up to 2^53 finite doubles: a fixed-point number that covers the range of doubles, as in Kulisch and
/// Miranker, "The arithmetic of the digital computer: a new approach", SIAM Review 28 (1986) 1-40.
class exact_sum {
public:
    /// The digits, of 32 bits each, the least significant first: the first has the weight 2^-1074.
    static constexpr int digits = detail::sum_digits;
    /// Their number as they are stored, between the sums of chunks.
    using stored = std::span<const std::int64_t, digits>;

    /// Adds a finite number.
    void add(double value);
    /// Adds a sum that was stored.
    void add(stored other);
    /// Stores the sum; equal sums are stored equally.
    void store(std::span<std::int64_t, digits> to);
    /// The sum times 2^exponent, rounded once, to nearest: with a negative exponent it does not overflow.
    double value(int exponent = 0) const;

private:
    void carry();

    // Each is less than 2^63 in magnitude: carried before as many numbers of 32 bits may have been added.
    std::array<std::int64_t, digits> digit_{};
    std::int64_t added_ = 0;
};

}  // namespace myriad::studies::inline MYRIAD_ABI
