// SPDX-License-Identifier: MIT
// Integers of 64 bits in packs whose lanes have 32: the numbers of instances in packs of float.
#pragma once

#include <cstdint>
#include <limits>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// One 64-bit integer per lane, in two packs `I` of 32-bit integers. A plain integer converts to that value in every
/// lane; a comparison gives a mask.
template <class I>
class wide_integer {
public:
    /// Of one lane.
    using value_type = std::int64_t;
    /// The same.
    using lane_type = std::int64_t;
    /// What comparisons give.
    using mask_type = typename I::mask_type;

    /// Not set.
    wide_integer() = default;
    /// The same number in every lane.
    MYRIAD_FUNCTION wide_integer(std::int64_t value) : low_(low_of(value)), high_(high_of(value)) {}
    /// The low 32 bits, as an integer of 32 bits takes them of one of 64.
    MYRIAD_FUNCTION operator I() const { return low_; }

    /// The number in a lane.
    static MYRIAD_FUNCTION std::int64_t get_lane(const wide_integer& a, int lane) {
        const auto low = static_cast<std::uint32_t>(I::get_lane(a.low_, lane));
        const auto high = static_cast<std::uint32_t>(I::get_lane(a.high_, lane));
        return static_cast<std::int64_t>(std::uint64_t{high} << 32 | low);
    }
    /// Puts a number into a lane.
    static MYRIAD_FUNCTION void set_lane(wide_integer& a, int lane, std::int64_t value) {
        I::set_lane(a.low_, lane, low_of(value));
        I::set_lane(a.high_, lane, high_of(value));
    }
    /// a where the mask holds, else b.
    static MYRIAD_FUNCTION wide_integer blend(const mask_type& mask, const wide_integer& a, const wide_integer& b) {
        wide_integer made;
        made.low_ = I::blend(mask, a.low_, b.low_);
        made.high_ = I::blend(mask, a.high_, b.high_);
        return made;
    }

    friend MYRIAD_FUNCTION wide_integer operator+(const wide_integer& a, const wide_integer& b) {
        wide_integer sum;
        sum.low_ = a.low_ + b.low_;
        sum.high_ = a.high_ + b.high_ + I::blend(less_as_natural(sum.low_, a.low_), I(1), I(0));
        return sum;
    }
    friend MYRIAD_FUNCTION wide_integer operator-(const wide_integer& a, const wide_integer& b) {
        wide_integer difference;
        difference.low_ = a.low_ - b.low_;
        difference.high_ = a.high_ - b.high_ - I::blend(less_as_natural(a.low_, b.low_), I(1), I(0));
        return difference;
    }
    friend MYRIAD_FUNCTION mask_type operator==(const wide_integer& a, const wide_integer& b) {
        return (a.low_ == b.low_) & (a.high_ == b.high_);
    }
    friend MYRIAD_FUNCTION mask_type operator!=(const wide_integer& a, const wide_integer& b) { return !(a == b); }
    friend MYRIAD_FUNCTION mask_type operator<(const wide_integer& a, const wide_integer& b) {
        return (a.high_ < b.high_) | ((a.high_ == b.high_) & less_as_natural(a.low_, b.low_));
    }
    friend MYRIAD_FUNCTION mask_type operator>(const wide_integer& a, const wide_integer& b) { return b < a; }
    friend MYRIAD_FUNCTION mask_type operator<=(const wide_integer& a, const wide_integer& b) { return !(b < a); }
    friend MYRIAD_FUNCTION mask_type operator>=(const wide_integer& a, const wide_integer& b) { return !(a < b); }

private:
    static MYRIAD_FUNCTION std::int32_t low_of(std::int64_t value) {
        return static_cast<std::int32_t>(static_cast<std::uint32_t>(value));
    }
    static MYRIAD_FUNCTION std::int32_t high_of(std::int64_t value) {
        return static_cast<std::int32_t>(static_cast<std::uint64_t>(value) >> 32);
    }
    static MYRIAD_FUNCTION mask_type less_as_natural(const I& a, const I& b) {
        const I half(std::numeric_limits<std::int32_t>::min());
        return (a + half) < (b + half);
    }

    I low_, high_;
};

}  // namespace myriad::inline MYRIAD_TARGET
