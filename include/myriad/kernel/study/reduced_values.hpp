// SPDX-License-Identifier: MIT
// What reductions over the instances of a study do with one value: find its bin, order it, cut it into digits of an
// exact sum. All in integers, so that the result depends neither on the order nor on who computes.
#pragma once

#include <cmath>
#include <cstdint>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/core/status.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::detail {

/// The types of values.
enum class value_type : std::int32_t { f64, f32, i64, i32, u8 };

/// Values of consecutive instances: value j of instance i is at `values[j * size + i]`. All are zero if it is null.
struct value_array {
    const void* values = nullptr;
    value_type type = value_type::f64;
    std::int64_t size = 0, inner = 1;
    /// Phases done in each instance: those from `from_phase` on that it did not do have no value. Null: all have.
    const std::int32_t* phases = nullptr;
    std::int32_t from_phase = 0;
};

/// What is made of them.
enum class reduction_kind : std::int32_t {
    histogram,   // the number in each bin, then below the first edge, above the last one, not finite or missing
    histograms,  // a histogram for each inner value
    maximum,     // the largest `ordered` number, 0 for none
    minimum,     // the largest `ordered` number of the negative ones
    sum,         // the digits of an exact sum, and how many numbers are in it
    moments,     // two of these: of the numbers, for all inner values, and behind them of their squares
    statuses,    // how many instances have each status
};

/// The digits of an exact sum: numbers of 32 bits, the first of weight 2^-1074, that may be negative or larger until
/// they are carried. With the number of values, they are what is stored for each sum.
inline constexpr int sum_digits = 67;

/// Three neighbouring digits that together are a number.
struct digits_of_number {
    int first;
    std::int64_t digit[3];
};

}  // namespace myriad::detail

namespace myriad::detail::inline MYRIAD_TARGET {

/// Value j of instance i, NaN if it was not computed: the values that stand for that are the fill values of results.
MYRIAD_FUNCTION double value_at(const value_array& all, std::int64_t i, std::int64_t j) {
    constexpr double none = nan_of<double>;
    constexpr std::int64_t none_64 = -std::int64_t{0x7fffffffffffffff} + 1;
    constexpr std::int32_t none_32 = -0x7fffffff;
    if (all.values == nullptr) return 0;
    if (all.phases != nullptr && j >= all.phases[i] - all.from_phase) return none;
    const std::int64_t at = j * all.size + i;
    switch (all.type) {
        case value_type::f64:
            return static_cast<const double*>(all.values)[at];
        case value_type::f32:
            return static_cast<double>(static_cast<const float*>(all.values)[at]);
        case value_type::i64: {
            const std::int64_t value = static_cast<const std::int64_t*>(all.values)[at];
            return value == none_64 ? none : static_cast<double>(value);
        }
        case value_type::i32: {
            const std::int32_t value = static_cast<const std::int32_t*>(all.values)[at];
            return value == none_32 ? none : static_cast<double>(value);
        }
        case value_type::u8: {
            const std::uint8_t value = static_cast<const std::uint8_t*>(all.values)[at];
            return value == 255 ? none : static_cast<double>(value);
        }
    }
    return none;
}

MYRIAD_FUNCTION bool is_finite_number(double value) {
    return (__builtin_bit_cast(std::uint64_t, value) >> 52 & 0x7ff) != 0x7ff;
}

/// The place of a value in a histogram with so many bins between increasing edges, the upper edge of the last bin
/// included: a bin, or the three places after them for values below, above, and not finite.
MYRIAD_FUNCTION std::int64_t place_in_histogram(double value, const double* edges, std::int64_t bins) {
    if (!is_finite_number(value)) return bins + 2;
    const double lowest = edges[0], highest = edges[bins];
    if (value < lowest) return bins;
    if (value >= highest) return value == highest ? bins - 1 : bins + 1;
    // Most histograms have bins of equal width; the guess is at most one bin wrong for them.
    const double share = (value - lowest) / (highest - lowest) * static_cast<double>(bins);
    std::int64_t guess = share < static_cast<double>(bins - 1) ? static_cast<std::int64_t>(share) : bins - 1;
    if (guess > 0 && value < edges[guess]) --guess;
    if (guess + 1 < bins && value >= edges[guess + 1]) ++guess;
    if (value >= edges[guess] && value < edges[guess + 1]) return guess;
    std::int64_t low = 0, high = bins;  // edges[low] <= value < edges[high]
    while (high - low > 1) {
        const std::int64_t middle = (low + high) / 2;
        (value < edges[middle] ? high : low) = middle;
    }
    return low;
}

/// A square as the exact sum of two numbers. It is not known of numbers so large that it, or a sum of many, overflows.
struct exact_square {
    double rounded, rest;
    bool is_known;
};
MYRIAD_FUNCTION exact_square square_of(double value) {
    const double rounded = value * value;
    return {rounded, std::fma(value, value, -rounded), value > -0x1p480 && value < 0x1p480};
}

/// A positive number for every finite one, in the same order, -0 before 0.
MYRIAD_FUNCTION std::uint64_t ordered(double value) {
    const auto bits = __builtin_bit_cast(std::uint64_t, value);
    return bits >> 63 != 0 ? ~bits : bits | std::uint64_t{1} << 63;
}
/// The number that `ordered` was made of.
MYRIAD_FUNCTION double number_of_ordered(std::uint64_t place) {
    return __builtin_bit_cast(double, place >> 63 != 0 ? place & ~(std::uint64_t{1} << 63) : ~place);
}

/// The digits of a finite number.
MYRIAD_FUNCTION digits_of_number digits_of(double value) {
    const auto bits = __builtin_bit_cast(std::uint64_t, value);
    const auto exponent = static_cast<int>(bits >> 52 & 0x7ff);
    const std::uint64_t fraction =
        (bits & ((std::uint64_t{1} << 52) - 1)) | (exponent > 0 ? std::uint64_t{1} << 52 : 0);
    const int place = exponent > 0 ? exponent - 1 : 0;  // of the lowest bit, above 2^-1074
    const int shift = place % 32;
    const std::uint64_t low = fraction << shift, high = shift > 0 ? fraction >> (64 - shift) : 0;
    const std::int64_t sign = bits >> 63 != 0 ? -1 : 1;
    return {place / 32,
            {sign * static_cast<std::int64_t>(low & 0xffffffff), sign * static_cast<std::int64_t>(low >> 32),
             sign * static_cast<std::int64_t>(high)}};
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
