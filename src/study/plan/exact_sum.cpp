// SPDX-License-Identifier: MIT
// Fixed-point sums.
#include "myriad/study/plan/exact_sum.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

constexpr std::int64_t low_bits = 0xffffffff;
constexpr std::int64_t most_added = std::int64_t{1} << 30;

}  // namespace

void exact_sum::add(double value) {
    const detail::digits_of_number added = detail::digits_of(value);
    for (std::size_t i = 0; i < 3; ++i) digit_[static_cast<std::size_t>(added.first) + i] += added.digit[i];
    if (++added_ == most_added) carry();
}

void exact_sum::add(stored other) {
    carry();
    for (std::size_t i = 0; i < digits; ++i) digit_[i] += other[i];
    carry();
}

void exact_sum::carry() {
    for (std::size_t i = 0; i + 1 < digits; ++i) {
        digit_[i + 1] += digit_[i] >> 32;
        digit_[i] &= low_bits;
    }
    added_ = 0;
}

void exact_sum::store(std::span<std::int64_t, digits> to) {
    carry();
    std::copy(digit_.begin(), digit_.end(), to.begin());
}

double exact_sum::value(int exponent) const {
    exact_sum sum = *this;
    sum.carry();
    const bool negative = sum.digit_[digits - 1] < 0;
    if (negative) {
        for (std::int64_t& d : sum.digit_) d = -d;
        sum.carry();
    }
    std::size_t top = digits - 1;
    while (top > 0 && sum.digit_[top] == 0) --top;
    if (top < 2) {  // below 2^-1010, where 64 bits hold all
        const auto all = static_cast<std::uint64_t>(sum.digit_[1]) << 32 | static_cast<std::uint64_t>(sum.digit_[0]);
        const double exact = std::ldexp(static_cast<double>(all), exponent - 1074);
        return negative ? -exact : exact;
    }
    // The first 64 bits, the last of which stands for all that follow: one rounding, by the conversion.
    const auto digit = [&](std::size_t i) { return static_cast<std::uint64_t>(sum.digit_[i]); };
    const int zeros = std::countl_zero(digit(top));  // of a digit below 2^63
    std::uint64_t leading = digit(top) << zeros;
    std::uint64_t rest = 0;
    int filled = 64 - zeros;
    for (std::size_t i = top; i-- > 0;) {
        const int room = 64 - filled;
        if (room >= 32) {
            leading |= digit(i) << (room - 32);
            filled += 32;
        } else {
            leading |= digit(i) >> (32 - room);
            rest |= digit(i) & ((std::uint64_t{1} << (32 - room)) - 1);
            filled = 64;
        }
    }
    if (rest != 0) leading |= 1;
    const double rounded =
        std::ldexp(static_cast<double>(leading), static_cast<int>(top) * 32 - zeros - 1074 + exponent);
    return negative ? -rounded : rounded;
}

}  // namespace myriad::studies::inline MYRIAD_ABI
