// SPDX-License-Identifier: MIT
// An indexed set of masks, for example one per event. For one instance they are bits of a word, as on a GPU each would
// otherwise take a register.
#pragma once

#include <cstdint>
#include <type_traits>

#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Words that hold a bit for each of `size` masks.
constexpr int words_for(int size) { return size > 0 ? (size + 31) / 32 : 1; }

/// `size` masks of kind M. Operators work on all of them at once.
template <class M, extent size>
class mask_set {
public:
    /// In every lane the bits of these words.
    static MYRIAD_FUNCTION mask_set from_bits(const std::uint32_t* words) {
        mask_set made;
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(size); ++j) made.masks_[j] = M(((words[j / 32] >> (j % 32)) & 1u) != 0);
        return made;
    }
    /// All masks in these lanes.
    static MYRIAD_FUNCTION mask_set all_in(const M& lanes) {
        mask_set made;
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(size); ++j) made.masks_[j] = lanes;
        return made;
    }
    MYRIAD_FUNCTION const M& operator[](int j) const { return masks_[j]; }
    MYRIAD_FUNCTION void set(int j, const M& value) { masks_[j] = value; }
    /// Sets mask j, which must not be set yet, where x is negative. Zeros may count as either.
    template <class S>
    MYRIAD_FUNCTION void set_negative(int j, const S& x) {
        masks_[j] = x < S(0);
    }
    MYRIAD_FUNCTION void clear() {
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(size); ++j) masks_[j] = M(false);
    }
    /// The lanes in which any of the masks holds.
    MYRIAD_FUNCTION M any_of() const {
        M joined = masks_[0];
        MYRIAD_UNROLL
        for (int j = 1; j < MYRIAD_LENGTH(size); ++j) joined = joined | masks_[j];
        return joined;
    }
    /// The lanes in which all of the masks hold.
    MYRIAD_FUNCTION M all_of() const { return !(~*this).any_of(); }
    /// The masks in these lanes, none elsewhere.
    MYRIAD_FUNCTION mask_set in(const M& lanes) const {
        return combined(*this, *this, [&](const M& a, const M&) MYRIAD_LAMBDA { return a & lanes; });
    }
    friend MYRIAD_FUNCTION mask_set operator~(const mask_set& a) {
        return combined(a, a, [](const M& x, const M&) MYRIAD_LAMBDA { return !x; });
    }
    friend MYRIAD_FUNCTION mask_set operator&(const mask_set& a, const mask_set& b) {
        return combined(a, b, [](const M& x, const M& y) MYRIAD_LAMBDA { return x & y; });
    }
    friend MYRIAD_FUNCTION mask_set operator|(const mask_set& a, const mask_set& b) {
        return combined(a, b, [](const M& x, const M& y) MYRIAD_LAMBDA { return x | y; });
    }
    friend MYRIAD_FUNCTION mask_set operator^(const mask_set& a, const mask_set& b) {
        return combined(a, b, [](const M& x, const M& y) MYRIAD_LAMBDA { return (x & (!y)) | ((!x) & y); });
    }
    MYRIAD_FUNCTION bool get(int j, int lane) const { return get_lane(masks_[j], lane); }
    MYRIAD_FUNCTION void set(int j, int lane, bool value) { set_lane(masks_[j], lane, value); }
    /// The masks of one lane.
    MYRIAD_FUNCTION mask_set<bool, size> of_lane(int lane) const {
        mask_set<bool, size> made;
        made.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(size); ++j) made.set(j, get(j, lane));
        return made;
    }
    MYRIAD_FUNCTION void set_of_lane(int lane, const mask_set<bool, size>& values) {
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(size); ++j) set(j, lane, values[j]);
    }

private:
    template <class Combine>
    static MYRIAD_FUNCTION mask_set combined(const mask_set& a, const mask_set& b, Combine&& combine) {
        mask_set made;
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(size); ++j) made.masks_[j] = combine(a.masks_[j], b.masks_[j]);
        return made;
    }
    vec<M, size> masks_;
};

template <extent size>
class mask_set<bool, size> {
public:
    static MYRIAD_FUNCTION mask_set from_bits(const std::uint32_t* words) {
        mask_set made;
        MYRIAD_UNROLL
        for (int k = 0; k < count; ++k) made.words_[k] = words[k];
        return made;
    }
    static MYRIAD_FUNCTION mask_set all_in(bool lane) {
        mask_set made;
        MYRIAD_UNROLL
        for (int k = 0; k < count; ++k) made.words_[k] = lane ? used(k) : 0u;
        return made;
    }
    MYRIAD_FUNCTION bool operator[](int j) const { return ((words_[j / 32] >> (j % 32)) & 1u) != 0; }
    MYRIAD_FUNCTION void set(int j, bool value) {
        const std::uint32_t bit = std::uint32_t(1) << (j % 32);
        words_[j / 32] = value ? words_[j / 32] | bit : words_[j / 32] & ~bit;
    }
    template <class R>
    MYRIAD_FUNCTION void set_negative(int j, R x) {
        using word = std::conditional_t<sizeof(R) == sizeof(std::uint64_t), std::uint64_t, std::uint32_t>;
        const auto high = static_cast<std::uint32_t>(__builtin_bit_cast(word, x) >> (8 * sizeof(R) - 32));
        words_[j / 32] |= (high >> (31 - j % 32)) & (std::uint32_t(1) << (j % 32));
    }
    MYRIAD_FUNCTION void clear() {
        MYRIAD_UNROLL
        for (int k = 0; k < count; ++k) words_[k] = 0;
    }
    MYRIAD_FUNCTION bool any_of() const {
        std::uint32_t joined = words_[0];
        MYRIAD_UNROLL
        for (int k = 1; k < count; ++k) joined |= words_[k];
        return joined != 0;
    }
    MYRIAD_FUNCTION bool all_of() const { return !(~*this).any_of(); }
    MYRIAD_FUNCTION mask_set in(bool lane) const {
        mask_set made;
        MYRIAD_UNROLL
        for (int k = 0; k < count; ++k) made.words_[k] = lane ? words_[k] : 0u;
        return made;
    }
    friend MYRIAD_FUNCTION mask_set operator~(const mask_set& a) {
        mask_set made;
        MYRIAD_UNROLL
        for (int k = 0; k < count; ++k) made.words_[k] = ~a.words_[k] & used(k);
        return made;
    }
    friend MYRIAD_FUNCTION mask_set operator&(mask_set a, const mask_set& b) {
        MYRIAD_UNROLL
        for (int k = 0; k < count; ++k) a.words_[k] &= b.words_[k];
        return a;
    }
    friend MYRIAD_FUNCTION mask_set operator|(mask_set a, const mask_set& b) {
        MYRIAD_UNROLL
        for (int k = 0; k < count; ++k) a.words_[k] |= b.words_[k];
        return a;
    }
    friend MYRIAD_FUNCTION mask_set operator^(mask_set a, const mask_set& b) {
        MYRIAD_UNROLL
        for (int k = 0; k < count; ++k) a.words_[k] ^= b.words_[k];
        return a;
    }
    MYRIAD_FUNCTION bool get(int j, int) const { return (*this)[j]; }
    MYRIAD_FUNCTION void set(int j, int, bool value) { set(j, value); }
    MYRIAD_FUNCTION mask_set of_lane(int) const { return *this; }
    /// Whether more than one mask holds.
    MYRIAD_FUNCTION bool several() const {
        std::uint32_t more = 0;
        MYRIAD_UNROLL
        for (int k = 0, before = 0; k < count; ++k) {
            more |= (words_[k] & (words_[k] - 1)) | (before != 0 ? words_[k] : 0u);
            before |= static_cast<int>(words_[k] != 0);
        }
        return more != 0;
    }
    MYRIAD_FUNCTION void set_of_lane(int, const mask_set& values) { *this = values; }

private:
    static constexpr int count = words_for(MYRIAD_CAPACITY(size));
    /// The bits of word k that stand for masks.
    static MYRIAD_FUNCTION std::uint32_t used(int k) {
        const int bits = MYRIAD_LENGTH(size) - 32 * k;
        if (bits < 0) return 0;  // only where the length is less than the capacity
        return bits >= 32 ? ~std::uint32_t(0) : (std::uint32_t(1) << bits) - 1;
    }
    std::uint32_t words_[count];
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
