// SPDX-License-Identifier: MIT
// What the kernel body needs of a scalar kind beside arithmetic: masks, blending and access to single lanes. Here for
// plain reals, whose mask is bool and whose pack is one lane; pack.hpp has the same for SIMD packs.
#pragma once

#include <cstdint>
#include <limits>
#include <type_traits>

#include "myriad/core/macros.hpp"

// Masks are joined by `&` and `|`, here and in models, since packs have no other; for a mask of one lane clang would
// have `&&` and `||` instead.
#if defined(__clang__) && __clang_major__ >= 14
#pragma clang diagnostic ignored "-Wbitwise-instead-of-logical"
#endif

namespace myriad::inline MYRIAD_TARGET {

/// Traits of a scalar kind: its real type, the type of its comparisons, its integers and its number of lanes.
template <class S>
struct scalar_traits {
    static_assert(std::is_floating_point_v<S>, "not a scalar kind: use double, float, pack or dual");
    using real = S;
    using mask = bool;
    using integer = std::int32_t;
    static constexpr int lanes = 1;
};

template <class S>
using real_of = typename scalar_traits<S>::real;
template <class S>
using mask_of = typename scalar_traits<S>::mask;
template <class S>
using integer_of = typename scalar_traits<S>::integer;
template <class S>
inline constexpr int lanes_of = scalar_traits<S>::lanes;

/// Spacing of the numbers next to one, the largest finite and the smallest normal number, infinity and NaN; device code may
/// not call the functions behind them.
template <class R>
inline constexpr R epsilon_of = std::numeric_limits<R>::epsilon();
template <class R>
inline constexpr R largest_of = std::numeric_limits<R>::max();
template <class R>
inline constexpr R smallest_normal_of = std::numeric_limits<R>::min();
template <class R>
inline constexpr R infinity_of = std::numeric_limits<R>::infinity();
template <class R>
inline constexpr R nan_of = std::numeric_limits<R>::quiet_NaN();

template <class T>
concept plain_number = std::is_arithmetic_v<T>;

// A number of a higher rank takes in those of a lower one: 0 plain numbers, 1 packs and masks, 2 dual numbers.
template <class S>
inline constexpr int kind_rank = 0;

namespace detail {

template <class A, class B>
struct common_kind {
    using type = std::conditional_t<(kind_rank<A> > kind_rank<B>), A, B>;
    static_assert(kind_rank<A> != kind_rank<B> || std::is_same_v<A, B>, "these two kinds of numbers do not mix");
};
template <plain_number A, plain_number B>
struct common_kind<A, B> : std::common_type<A, B> {};
// A double beside a float is taken as a literal of a float model, whose arithmetic must not turn into double's.
template <>
struct common_kind<float, double> : std::type_identity<float> {};
template <>
struct common_kind<double, float> : std::type_identity<float> {};

template <class Mask, class A, class B>
struct selected {
    using type = typename common_kind<A, B>::type;
};
template <class Mask, plain_number A, plain_number B>
requires(!plain_number<Mask>)  // `a & b` of two bools is an int
    struct selected<Mask, A, B> {
    using type = std::conditional_t<std::is_same_v<A, bool> && std::is_same_v<B, bool>, Mask, typename Mask::pack_type>;
};

/// x as an S, narrowed on purpose where a double literal meets a float kind.
template <class S, class A>
MYRIAD_FUNCTION constexpr S to_kind(const A& x) {
    if constexpr (plain_number<A> && !plain_number<S>) {
        return S(static_cast<typename S::value_type>(x));
    } else {
        return static_cast<S>(x);
    }
}

}  // namespace detail

/// The kind of number in which an A and a B meet, such as a pack for a pack and a literal.
template <class A, class B>
using common_kind = typename detail::common_kind<A, B>::type;

/// a where the mask holds, else b. Both are evaluated. Kinds may be mixed: `select(x > 0.0, x, 0.0)`; the mask may be a
/// plain bool beside packs.
template <class Mask, class A, class B>
MYRIAD_FUNCTION constexpr auto select(const Mask& mask, const A& a, const B& b) {
    using S = typename detail::selected<Mask, A, B>::type;
    if constexpr (plain_number<S>) {
        return mask ? static_cast<S>(a) : static_cast<S>(b);
    } else {
        return blend(mask, detail::to_kind<S>(a), detail::to_kind<S>(b));  // found beside the pack or dual number
    }
}
MYRIAD_FUNCTION constexpr bool any(bool mask) { return mask; }
MYRIAD_FUNCTION constexpr bool all(bool mask) { return mask; }
/// The lanes of a mask as bits, lane i as bit i.
MYRIAD_FUNCTION constexpr std::uint64_t bits(bool mask) { return mask ? 1u : 0u; }

/// Lane i of a scalar, a pack or a mask; `set_lane` writes it.
template <plain_number T>
MYRIAD_FUNCTION constexpr T get_lane(T value, int) {
    return value;
}
template <plain_number T>
MYRIAD_FUNCTION constexpr void set_lane(T& value, int, std::type_identity_t<T> lane) {
    value = lane;
}

}  // namespace myriad::inline MYRIAD_TARGET
