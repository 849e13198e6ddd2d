// SPDX-License-Identifier: MIT
// Operations beyond arithmetic that the kernel body needs of a scalar kind: masks, blending and access to single lanes.
// Here for plain reals, whose mask is bool and which count as packs of one lane; for SIMD packs in pack.hpp.
#pragma once

#include <cstdint>
#include <limits>
#include <type_traits>

#include "myriad/kernel/core/macros.hpp"

// Masks are combined with `&` and `|`, here and in models, as packs have nothing else; for a mask of one lane clang
// would suggest `&&` and `||`.
#if defined(__clang__) && __clang_major__ >= 14
#pragma clang diagnostic ignored "-Wbitwise-instead-of-logical"
#endif

namespace myriad::detail::inline MYRIAD_TARGET {

/// Traits of a scalar kind: its real type, its mask, its integer type and its number of lanes.
template <class S>
struct scalar_traits {
    static_assert(std::is_floating_point_v<S>, "not a scalar kind: use double, float, pack or dual");
    using real = S;
    using mask = bool;
    using integer = std::int32_t;
    static constexpr int lanes = 1;
};

template <class T>
concept plain_number = std::is_arithmetic_v<T>;

// The rank of a kind: 0 plain numbers, 1 packs and masks, 2 dual numbers. Mixed arithmetic has the kind of higher rank.
template <class S>
inline constexpr int kind_rank = 0;

template <class A, class B>
struct common_kind_of {
    using type = std::conditional_t<(kind_rank<A> > kind_rank<B>), A, B>;
    static_assert(kind_rank<A> != kind_rank<B> || std::is_same_v<A, B>, "these two kinds of numbers do not mix");
};
template <plain_number A, plain_number B>
struct common_kind_of<A, B> : std::common_type<A, B> {};
// A double next to a float is taken for a literal in a float model, whose arithmetic must stay in float.
template <>
struct common_kind_of<float, double> : std::type_identity<float> {};
template <>
struct common_kind_of<double, float> : std::type_identity<float> {};

/// The common kind of A and B, such as a pack for a pack and a literal.
template <class A, class B>
using common_kind = typename common_kind_of<A, B>::type;

template <class Mask, class A, class B>
struct selected {
    using type = typename common_kind_of<A, B>::type;
};
template <class Mask, plain_number A, plain_number B>
requires(!plain_number<Mask>)  // `a & b` of two bools is an int
    struct selected<Mask, A, B> {
    using type = std::conditional_t<std::is_same_v<A, bool> && std::is_same_v<B, bool>, Mask, typename Mask::pack_type>;
};

/// x as an S, narrowed deliberately if a double literal meets a float kind.
template <class S, class A>
MYRIAD_FUNCTION S to_kind(const A& x) {
    if constexpr (plain_number<A> && !plain_number<S>) {
        return S(static_cast<typename S::value_type>(x));
    } else {
        return static_cast<S>(x);
    }
}

}  // namespace myriad::detail::inline MYRIAD_TARGET

namespace myriad::inline MYRIAD_TARGET {

/// The real type of a kind of number: double or float.
template <class S>
using real_of = typename detail::scalar_traits<S>::real;
/// The type of its comparisons: bool for a plain number, one truth value per lane for a pack.
template <class S>
using mask_of = typename detail::scalar_traits<S>::mask;
/// Its integers: `int32` for a plain number, as many as lanes for a pack.
template <class S>
using integer_of = typename detail::scalar_traits<S>::integer;
/// Its number of lanes: 1 for a plain number.
template <class S>
inline constexpr int lanes_of = detail::scalar_traits<S>::lanes;
/// Whether it is a pack of several lanes.
template <class S>
concept is_pack = lanes_of<S> >
1;

// Constants of the real type, since device code may not call the functions behind them, which know no other kind.
/// Spacing of the numbers next to one.
template <class S>
inline constexpr real_of<S> epsilon_of = std::numeric_limits<real_of<S>>::epsilon();
/// The largest finite number.
template <class S>
inline constexpr real_of<S> largest_of = std::numeric_limits<real_of<S>>::max();
/// The smallest positive normal number.
template <class S>
inline constexpr real_of<S> smallest_normal_of = std::numeric_limits<real_of<S>>::min();
/// Infinity.
template <class S>
inline constexpr real_of<S> infinity_of = std::numeric_limits<real_of<S>>::infinity();
/// A quiet NaN.
template <class S>
inline constexpr real_of<S> nan_of = std::numeric_limits<real_of<S>>::quiet_NaN();

/// a where the mask holds, otherwise b. Both are evaluated. Kinds may be mixed: `select(x > 0.0, x, 0.0)`; with packs
/// the mask may be a plain bool.
template <class Mask, class A, class B>
MYRIAD_FUNCTION auto select(const Mask& mask, const A& a, const B& b) {
    using S = typename detail::selected<Mask, A, B>::type;
    if constexpr (detail::plain_number<S>) {
        return mask ? static_cast<S>(a) : static_cast<S>(b);
    } else {
        return S::blend(mask, detail::to_kind<S>(a), detail::to_kind<S>(b));
    }
}
}  // namespace myriad::inline MYRIAD_TARGET

namespace myriad::detail::inline MYRIAD_TARGET {

/// Whether a mask holds in some lane, and in all.
MYRIAD_FUNCTION bool any(bool mask) { return mask; }
MYRIAD_FUNCTION bool all(bool mask) { return mask; }
/// The lanes of a mask as bits, lane i as bit i.
MYRIAD_FUNCTION std::uint64_t bits(bool mask) { return mask ? 1u : 0u; }

/// Lane i of a scalar, a pack or a mask; `set_lane` writes it.
template <plain_number T>
MYRIAD_FUNCTION T get_lane(T value, int) {
    return value;
}
template <plain_number T>
MYRIAD_FUNCTION void set_lane(T& value, int, std::type_identity_t<T> lane) {
    value = lane;
}

// The same for kinds that are classes, by their static members: a function found by argument-dependent look-up could
// clash with a model's function of that name.
template <class S>
requires(!plain_number<S>) MYRIAD_FUNCTION bool any(const S& mask) { return S::any(mask); }
template <class S>
requires(!plain_number<S>) MYRIAD_FUNCTION bool all(const S& mask) { return S::all(mask); }
template <class S>
requires(!plain_number<S>) MYRIAD_FUNCTION std::uint64_t bits(const S& mask) { return S::bits(mask); }
template <class S>
requires(!plain_number<S>) MYRIAD_FUNCTION typename S::lane_type get_lane(const S& all, int lane) {
    return S::get_lane(all, lane);
}
template <class S>
requires(!plain_number<S>) MYRIAD_FUNCTION void set_lane(S& all, int lane, typename S::lane_type value) {
    S::set_lane(all, lane, value);
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
