// SPDX-License-Identifier: MIT
// Operations on single lanes of a mask, per-lane counts, and a test whether all components of a vector are finite.
#pragma once

#include <cstdint>
#include <type_traits>
#include <utility>

#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// A counter of steps: an integer for one instance, a real (exact up to its mantissa) per lane of a pack.
template <class S>
using count_of = std::conditional_t<lanes_of<S> == 1, std::int32_t, S>;

/// Whether every component is finite, lane by lane.
template <class S, extent n>
MYRIAD_FUNCTION mask_of<S> all_finite(const vec<S, n>& y) {
    mask_of<S> finite = is_finite(y[0]);
    MYRIAD_UNROLL_UP_TO(32, 128)
    for (int c = 1; c < MYRIAD_LENGTH(n); ++c) finite = finite & is_finite(y[c]);
    return finite;
}

/// The type of one lane of a counter.
template <class C>
using lane_of = std::conditional_t<std::is_integral_v<C>, C, decltype(get_lane(std::declval<C>(), 0))>;

/// count + amount where the mask holds.
template <class C, class M>
MYRIAD_FUNCTION C count_where(const M& mask, const C& count, int amount = 1) {
    return select(mask, count + C(static_cast<lane_of<C>>(amount)), count);
}

/// Adds one to the count of lane i.
template <class C>
MYRIAD_FUNCTION void add_to_count(C& count, int i) {
    if constexpr (std::is_integral_v<C>) {
        ++count;
    } else {
        set_lane(count, i, get_lane(count, i) + real_of<C>(1));
    }
}

/// Sets the count of lane i.
template <class C, class R>
MYRIAD_FUNCTION void set_count(C& count, int i, R value) {
    if constexpr (std::is_integral_v<C>) {
        count = static_cast<C>(value);
    } else {
        set_lane(count, i, static_cast<real_of<C>>(value));
    }
}

/// Calls `visit(i)` for every lane of the mask.
template <class M, class Visit>
MYRIAD_FUNCTION void for_each_lane(const M& mask, Visit&& visit) {
    if constexpr (plain_number<M>) {
        if (mask) visit(0);
    } else {
        for (std::uint64_t rest = bits(mask); rest != 0; rest &= rest - 1) visit(__builtin_ctzll(rest));
    }
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
