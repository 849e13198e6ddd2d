// SPDX-License-Identifier: MIT
// Normal numbers from counters, without branches: a block of Philox and the transform of Box and Muller, for one plain
// real or one SIMD batch, by the same operations in the same order.
#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/scalar/arithmetic.hpp"
#include "myriad/kernel/scalar/exponential.hpp"
#include "myriad/kernel/scalar/fast_float.hpp"
#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/scalar/philox_keys.hpp"
#include "myriad/kernel/scalar/trigonometry.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Words of 32 bits, one for each lane of B, a plain real or, in pack_normal_numbers.hpp, a batch. Bits above the 32nd
/// may be anything there.
template <class B>
struct random_words;

inline constexpr std::uint32_t sign_bit = 0x80000000;

template <std::floating_point T>
struct random_words<T> {
    using word = std::uint32_t;
    struct product {
        word high, low;
    };

    static MYRIAD_FUNCTION product multiply(word a, std::uint32_t by) {
        const std::uint64_t all = std::uint64_t{by} * a;
        return {static_cast<word>(all >> 32), static_cast<word>(all)};
    }
    /// The number in [1, 2) that has these 52 bits after the point.
    static MYRIAD_FUNCTION double from_one_to_two(word low, word high) {
        const std::uint64_t bits = std::uint64_t{high} << 32 | low;
        return __builtin_bit_cast(double, bits >> 12 | 0x3ff0000000000000);
    }
    /// The word as an integer with a sign, rounded.
    static MYRIAD_FUNCTION float whole(word a) { return static_cast<float>(static_cast<std::int32_t>(a)); }
    /// The number, with its sign changed if the highest bit of the word is set.
    static MYRIAD_FUNCTION float with_sign_of(float x, word a) {
        return __builtin_bit_cast(float, __builtin_bit_cast(word, x) ^ (a & sign_bit));
    }
    static MYRIAD_FUNCTION T root(T x) { return functions<T>::sqrt(x); }
};

/// Philox4x32-10 of the counter w, in its place (model/random.hpp has the source).
template <class B>
MYRIAD_FUNCTION void philox_of_words(typename random_words<B>::word (&w)[4], const philox_keys& keys) {
    using words = random_words<B>;
    MYRIAD_UNROLL
    for (int round = 0; round < philox_keys::rounds; ++round) {
        const auto a = words::multiply(w[0], 0xd2511f53), b = words::multiply(w[2], 0xcd9e8d57);
        w[0] = b.high ^ w[1] ^ typename words::word(keys.of_round[round][0]);
        w[2] = a.high ^ w[3] ^ typename words::word(keys.of_round[round][1]);
        w[1] = b.low;
        w[3] = a.low;
    }
}

/// How many normal numbers one block gives.
template <class R>
inline constexpr int normals_per_block = sizeof(R) == sizeof(double) ? 2 : 4;

/// Two independent normal numbers from u in (0, 1] and an angle in half turns: Box and Muller, Ann. Math. Statist. 29
/// (1958) 610.
template <class B>
MYRIAD_FUNCTION void box_muller(const B& u, const B& half_turns, B& first, B& second) {
    using T = typename arithmetic<B>::real;
    const B radius = random_words<B>::root(B(T(-2)) * exponential<B>::log(u));
    B sine, cosine;
    trigonometry<B>::sincospi(half_turns, sine, cosine);
    first = radius * cosine;
    second = radius * sine;
}

/// The root of -log(u), for u in (0, 1].
template <class B>
MYRIAD_FUNCTION B root_of_minus_log(const B& u) {
#if MYRIAD_FAST_FLOAT
    if constexpr (std::is_same_v<B, float>) return fast_float<B>::root_of_minus_log(u);
#endif
    return random_words<B>::root(-exponential<B>::log_of_finite(u));
}

/// The same in single precision from two words, with half of the operations. The highest bits of the words choose
/// a quarter of the plane. In it the angle is pi / 4 + r, with r between -pi / 4 and pi / 4, so that none is reduced:
/// its cosine is (cos(r) - sin(r)) / sqrt(2), its sine (cos(r) + sin(r)) / sqrt(2).
template <class B>
MYRIAD_FUNCTION void box_muller_of_words(const typename random_words<B>::word& of_radius,
                                         const typename random_words<B>::word& of_angle, B& first, B& second) {
    using A = arithmetic<B>;
    using T = typename A::real;
    using words = random_words<B>;
    using word = typename words::word;
    const B u = A::multiply_add(words::whole(of_radius & word(~sign_bit)), B(T(0x1p-31)), B(T(0x1p-32)));
    const B radius = detail::root_of_minus_log(u);
    const typename trigonometry<B>::angle r{words::whole(of_angle << 1) * B(functions<T>::pi * T(0x1p-33)), {}};
    const B cosine = trigonometry<B>::cosine_of_rest(r), sine = trigonometry<B>::sine_of_rest(r);
    first = words::with_sign_of(radius * (cosine - sine), of_radius);
    second = words::with_sign_of(radius * (cosine + sine), of_angle);
}

/// The normal numbers of a counter. In double precision u is the midpoint of one of 2^52 equal parts of (0, 1), so that
/// they are within +-8.6; in single precision a multiple of 2^-31 and 2^-32 more, rounded, which gives +-6.66.
template <class B>
MYRIAD_FUNCTION void normal_numbers(typename random_words<B>::word (&w)[4], const philox_keys& keys,
                                    B (&z)[normals_per_block<typename arithmetic<B>::real>]) {
    using A = arithmetic<B>;
    using T = typename A::real;
    using words = random_words<B>;
    detail::philox_of_words<B>(w, keys);
    if constexpr (sizeof(T) == sizeof(double)) {
        const B u = words::from_one_to_two(w[0], w[1]) - B(T(1 - 0x1p-53));
        const B angle = A::multiply_add(B(T(2)), words::from_one_to_two(w[2], w[3]), B(T(-3)));
        detail::box_muller(u, angle, z[0], z[1]);
    } else {
        detail::box_muller_of_words<B>(w[0], w[1], z[0], z[1]);
        detail::box_muller_of_words<B>(w[2], w[3], z[2], z[3]);
    }
}

/// Groups of processes. Those whose numbers are higher by this draw more of the same processes: path_integral.hpp.
inline constexpr int groups_of_increments = 128;

/// Integers of the lanes of S as paths have them: the numbers of cells, which single precision cannot tell apart beyond
/// 32 bits; small numbers; and words of a counter.
template <class S>
struct path_integers {
    using cell = std::conditional_t<sizeof(S) == sizeof(double), std::int64_t, std::int32_t>;
    using small = std::int32_t;
    using word = std::uint32_t;
};

/// What a block of a path is the block of. The counter is (the low word of `cell`; `owner`; 8 further bits of `cell`,
/// or zero if it has none, 16 of `node`, 8 of `group`; `epoch`).
template <class S>
struct block_place {
    typename path_integers<S>::cell cell;
    typename path_integers<S>::small node;
    int group;
    typename path_integers<S>::word owner, epoch;
};

/// The normal numbers of a block, in every lane.
template <class S>
struct normals_of {
    static MYRIAD_FUNCTION vec<S, normals_per_block<S>> at(const block_place<S>& p, const philox_keys& keys) {
        std::uint32_t high = 0;
        if constexpr (sizeof(p.cell) == 8) high = static_cast<std::uint32_t>(static_cast<std::uint64_t>(p.cell) >> 32);
        std::uint32_t w[4] = {
            static_cast<std::uint32_t>(p.cell), p.owner,
            high << 24 | static_cast<std::uint32_t>(p.node) << 8 | static_cast<std::uint32_t>(p.group), p.epoch};
        S z[normals_per_block<S>];
        detail::normal_numbers<S>(w, keys, z);
        vec<S, normals_per_block<S>> all;
        MYRIAD_UNROLL
        for (int k = 0; k < normals_per_block<S>; ++k) all[k] = z[k];
        return all;
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
