// SPDX-License-Identifier: MIT
// An indexed set of masks, for example one per event. For one instance they are bits of a word, as on a GPU each would
// otherwise take a register.
#pragma once

#include <cstdint>

#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// `size` masks of type M.
template <class M, int size>
class mask_set {
public:
    MYRIAD_FUNCTION const M& operator[](int j) const { return masks_[j]; }
    MYRIAD_FUNCTION void set(int j, const M& value) { masks_[j] = value; }
    MYRIAD_FUNCTION void clear() {
        MYRIAD_UNROLL
        for (int j = 0; j < size; ++j) masks_[j] = M(false);
    }
    /// The lanes in which any of the masks holds.
    MYRIAD_FUNCTION M any_of() const {
        M joined = masks_[0];
        MYRIAD_UNROLL
        for (int j = 1; j < size; ++j) joined = joined | masks_[j];
        return joined;
    }
    MYRIAD_FUNCTION bool get(int j, int lane) const { return get_lane(masks_[j], lane); }
    MYRIAD_FUNCTION void set(int j, int lane, bool value) { set_lane(masks_[j], lane, value); }

private:
    vec<M, size> masks_;
};

template <int size>
class mask_set<bool, size> {
public:
    MYRIAD_FUNCTION bool operator[](int j) const { return ((words_[j / 32] >> (j % 32)) & 1u) != 0; }
    MYRIAD_FUNCTION void set(int j, bool value) {
        const std::uint32_t bit = std::uint32_t(1) << (j % 32);
        words_[j / 32] = value ? words_[j / 32] | bit : words_[j / 32] & ~bit;
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
    MYRIAD_FUNCTION bool get(int j, int) const { return (*this)[j]; }
    MYRIAD_FUNCTION void set(int j, int, bool value) { set(j, value); }

private:
    static constexpr int count = size > 0 ? (size + 31) / 32 : 1;
    std::uint32_t words_[count];
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
