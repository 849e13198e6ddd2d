// SPDX-License-Identifier: MIT
// A SIMD pack and its mask, the scalar kind of the OpenMP backend: several independent xsimd batches, because a single
// one is bound by latency (measured with Lorenz and RK4: 0.94 ns per step and instance with one, 0.62 with four). Host
// compilers only: nvcc refuses SIMD types.
#pragma once

#include <concepts>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/batch.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::inline MYRIAD_TARGET {

template <class T, int batches>
class pack;

/// One truth value per lane, the result of comparing packs. `T` is the real type of the same width. Operators work lane
/// by lane and never short-circuit.
template <class T, int batches>
class pack_mask {
public:
    static_assert(std::is_floating_point_v<T> && batches >= 1 && batches <= 4);
    using value_type = bool;
    using lane_type = bool;
    using batch_type = xsimd::batch_bool<T>;
    using pack_type = pack<T, batches>;
    static constexpr int lanes_per_batch = static_cast<int>(xsimd::batch<T>::size);
    static constexpr int lanes = batches * lanes_per_batch;
    static_assert(lanes <= 64, "bits() needs at most 64 lanes");

    batch_type parts[batches];

    pack_mask() = default;
    // Batch by batch, as g++ copies trivial arrays of batches in pieces of 16 bytes, on which wider loads then stall;
    // and register by register, as it copies whole batches through memory.
    MYRIAD_FUNCTION pack_mask(const pack_mask& other) { MYRIAD_EACH_BATCH(parts[i].data = other.parts[i].data); }
    MYRIAD_FUNCTION pack_mask& operator=(const pack_mask& other) {
        MYRIAD_EACH_BATCH(parts[i].data = other.parts[i].data);
        return *this;
    }
    /// The same value in every lane.
    MYRIAD_FUNCTION pack_mask(bool value) { MYRIAD_EACH_BATCH(parts[i] = batch_type(value)); }

    /// A mask has no single truth value: this only explains why `if (x < y)` does not compile.
    template <std::same_as<bool> B>
    explicit operator B() const {
        static_assert(
            sizeof(B) == 0,
            "this model branches on its state: use myriad::select(condition, a, b), for std::min and std::max "
            "myriad::min and myriad::max, or declare `static constexpr bool scalar_only = true;` in the model");
        return false;
    }

#define MYRIAD_MASK_OPERATOR(symbol, expression)                                                                   \
    friend MYRIAD_FUNCTION pack_mask operator symbol(const pack_mask& a, const pack_mask& b) {                     \
        pack_mask result;                                                                                          \
        const auto join = [](auto x, auto y) MYRIAD_LAMBDA { return expression; };                                 \
        MYRIAD_EACH_BATCH(result.parts[i].data = detail::join_masks(join, a.parts[i], b.parts[i]).data);           \
        return result;                                                                                             \
    }                                                                                                              \
    friend MYRIAD_FUNCTION pack_mask operator symbol(const pack_mask& a, bool b) { return a symbol pack_mask(b); } \
    friend MYRIAD_FUNCTION pack_mask operator symbol(bool a, const pack_mask& b) { return pack_mask(a) symbol b; }
    MYRIAD_MASK_OPERATOR(&, x& y)
    MYRIAD_MASK_OPERATOR(|, x | y)
    MYRIAD_MASK_OPERATOR(^, x ^ y)
    MYRIAD_MASK_OPERATOR(&&, x& y)
    MYRIAD_MASK_OPERATOR(||, x | y)
    MYRIAD_MASK_OPERATOR(!=, x ^ y)
    MYRIAD_MASK_OPERATOR(==, ~(x ^ y))
#undef MYRIAD_MASK_OPERATOR

    friend MYRIAD_FUNCTION pack_mask operator!(const pack_mask& a) {
        pack_mask result;
        const auto invert = [](auto x) MYRIAD_LAMBDA { return ~x; };
        MYRIAD_EACH_BATCH(result.parts[i].data = detail::join_masks(invert, a.parts[i]).data);
        return result;
    }
    MYRIAD_FUNCTION pack_mask& operator&=(const pack_mask& b) { return *this = *this & b; }
    MYRIAD_FUNCTION pack_mask& operator|=(const pack_mask& b) { return *this = *this | b; }
    MYRIAD_FUNCTION pack_mask& operator^=(const pack_mask& b) { return *this = *this ^ b; }

    /// Whether the mask holds in some lane. The batches are joined first, so that a pack takes one test and one jump.
    static MYRIAD_FUNCTION bool any(const pack_mask& a) {
        batch_type joined = a.parts[0];
        MYRIAD_EACH_BATCH(if constexpr (i > 0) joined = joined | a.parts[i]);
        return xsimd::any(joined);
    }
    /// Whether the mask holds in every lane.
    static MYRIAD_FUNCTION bool all(const pack_mask& a) {
        batch_type joined = a.parts[0];
        MYRIAD_EACH_BATCH(if constexpr (i > 0) joined = joined & a.parts[i]);
        return xsimd::all(joined);
    }
    /// The lanes as bits, lane i as bit i.
    static MYRIAD_FUNCTION std::uint64_t bits(const pack_mask& a) {
        std::uint64_t result = 0;
        MYRIAD_EACH_BATCH(result |= detail::bits_of<T>(a.parts[i]) << (i * lanes_per_batch));
        return result;
    }

    static MYRIAD_FUNCTION bool get_lane(const pack_mask& a, int lane) {
        if constexpr (detail::has_bit_mask<batch_type>) {
            using bits_type = typename batch_type::register_type;
            const auto register_bits = static_cast<bits_type>(a.parts[lane / lanes_per_batch]);
            return (static_cast<std::uint64_t>(register_bits) >> (lane % lanes_per_batch) & 1u) != 0;
        } else {
            detail::integer_of_width<T> value;
            std::memcpy(&value, reinterpret_cast<const char*>(a.parts) + static_cast<std::size_t>(lane) * sizeof value,
                        sizeof value);
            return value != 0;
        }
    }
    static MYRIAD_FUNCTION void set_lane(pack_mask& a, int lane, bool value) {
        if constexpr (detail::has_bit_mask<batch_type>) {
            using bits_type = typename batch_type::register_type;
            batch_type& part = a.parts[lane / lanes_per_batch];
            const std::uint64_t bit = std::uint64_t{1} << (lane % lanes_per_batch);
            const std::uint64_t old = static_cast<bits_type>(part);
            part = batch_type(static_cast<bits_type>(value ? old | bit : old & ~bit));
        } else {
            const detail::integer_of_width<T> filled = value ? -1 : 0;
            std::memcpy(reinterpret_cast<char*>(a.parts) + static_cast<std::size_t>(lane) * sizeof filled, &filled,
                        sizeof filled);
        }
    }

    static MYRIAD_FUNCTION pack_mask blend(const pack_mask& mask, const pack_mask& a, const pack_mask& b) {
        return (mask & a) | ((!mask) & b);
    }
};

/// `batches` xsimd batches of `T` (double, float, std::int64_t or std::int32_t), used like one number. Default
/// construction leaves it uninitialised; a plain number converts to that value in every lane.
template <class T, int batches>
class pack {
public:
    static_assert(std::is_same_v<T, double> || std::is_same_v<T, float> || std::is_same_v<T, std::int64_t> ||
                  std::is_same_v<T, std::int32_t>);
    static_assert(batches >= 1 && batches <= 4, "a pack has one to four batches");
    using value_type = T;
    using lane_type = T;
    using batch_type = xsimd::batch<T>;
    using real = detail::real_of_width<T>;
    using mask_type = pack_mask<real, batches>;
    static constexpr int lanes_per_batch = static_cast<int>(batch_type::size);
    static constexpr int lanes = batches * lanes_per_batch;
    static constexpr bool is_real = std::is_floating_point_v<T>;

    batch_type parts[batches];

    pack() = default;
    // Batch by batch, for the same reason as masks.
    MYRIAD_FUNCTION pack(const pack& other) { MYRIAD_EACH_BATCH(parts[i].data = other.parts[i].data); }
    MYRIAD_FUNCTION pack& operator=(const pack& other) {
        MYRIAD_EACH_BATCH(parts[i].data = other.parts[i].data);
        return *this;
    }
    MYRIAD_FUNCTION pack(T value) { MYRIAD_EACH_BATCH(parts[i] = batch_type(value)); }

    /// Reads `lanes` contiguous values; the aligned form needs `xsimd::default_arch::alignment()` bytes.
    static MYRIAD_FUNCTION pack load(const T* from) {
        pack result;
        MYRIAD_EACH_BATCH(result.parts[i] = batch_type::load_unaligned(from + i * lanes_per_batch));
        return result;
    }
    static MYRIAD_FUNCTION pack load_aligned(const T* from) {
        pack result;
        MYRIAD_EACH_BATCH(result.parts[i] = batch_type::load_aligned(from + i * lanes_per_batch));
        return result;
    }
    MYRIAD_FUNCTION void store(T* to) const { MYRIAD_EACH_BATCH(parts[i].store_unaligned(to + i * lanes_per_batch)); }
    MYRIAD_FUNCTION void store_aligned(T* to) const {
        MYRIAD_EACH_BATCH(parts[i].store_aligned(to + i * lanes_per_batch));
    }

#define MYRIAD_PACK_OPERATOR(symbol, condition)                                           \
    friend MYRIAD_FUNCTION pack operator symbol(const pack& a, const pack& b) condition { \
        pack result;                                                                      \
        MYRIAD_EACH_BATCH(result.parts[i] = a.parts[i] symbol b.parts[i]);                \
        return result;                                                                    \
    }                                                                                     \
    MYRIAD_FUNCTION pack& operator symbol##=(const pack& b) condition { return *this = *this symbol b; }
    MYRIAD_PACK_OPERATOR(+, )
    MYRIAD_PACK_OPERATOR(-, )
    MYRIAD_PACK_OPERATOR(*, requires is_real)
    MYRIAD_PACK_OPERATOR(/, requires is_real)
#undef MYRIAD_PACK_OPERATOR

    friend MYRIAD_FUNCTION pack operator-(const pack& a) {
        pack result;
        // The compiler's own vector negation: xsimd's is 0 - x on AVX-512, which loses the sign of zero, and a bitwise
        // one cannot be folded into a fused multiply-add.
        if constexpr (is_real) {
            MYRIAD_EACH_BATCH(result.parts[i] =
                                  batch_type(-static_cast<typename batch_type::register_type>(a.parts[i])));
        } else {
            MYRIAD_EACH_BATCH(result.parts[i] = batch_type(T{0}) - a.parts[i]);
        }
        return result;
    }
    friend MYRIAD_FUNCTION pack operator+(const pack& a) { return a; }

#define MYRIAD_PACK_COMPARISON(symbol, expression)                                   \
    friend MYRIAD_FUNCTION mask_type operator symbol(const pack& a, const pack& b) { \
        mask_type result;                                                            \
        MYRIAD_EACH_BATCH(result.parts[i] = detail::mask_cast<real>(expression));    \
        return result;                                                               \
    }
    MYRIAD_PACK_COMPARISON(<, a.parts[i] < b.parts[i])
    MYRIAD_PACK_COMPARISON(<=, a.parts[i] <= b.parts[i])
    MYRIAD_PACK_COMPARISON(>, a.parts[i] > b.parts[i])
    MYRIAD_PACK_COMPARISON(>=, a.parts[i] >= b.parts[i])
    MYRIAD_PACK_COMPARISON(==, a.parts[i] == b.parts[i])
    MYRIAD_PACK_COMPARISON(!=, ~(a.parts[i] == b.parts[i]))  // xsimd 8: NaN != NaN is false
#undef MYRIAD_PACK_COMPARISON

    static MYRIAD_FUNCTION T get_lane(const pack& a, int lane) {
        T value;
        std::memcpy(&value, reinterpret_cast<const char*>(a.parts) + static_cast<std::size_t>(lane) * sizeof value,
                    sizeof value);
        return value;
    }
    static MYRIAD_FUNCTION void set_lane(pack& a, int lane, T value) {
        std::memcpy(reinterpret_cast<char*>(a.parts) + static_cast<std::size_t>(lane) * sizeof value, &value,
                    sizeof value);
    }

    static MYRIAD_FUNCTION pack blend(const mask_type& mask, const pack& a, const pack& b) {
        pack result;
        // Integers are selected as reals, since xsimd 8 cannot select them for AVX-512 in unoptimised builds.
        using detail::bits_as;
        MYRIAD_EACH_BATCH(result.parts[i] = bits_as<T>(
                              xsimd::select(mask.parts[i], bits_as<real>(a.parts[i]), bits_as<real>(b.parts[i]))));
        return result;
    }
    /// Of whole numbers, the low 32 bits with their sign.
    static MYRIAD_FUNCTION pack wrapped_to_32_bits(const pack& a) requires(!is_real) {
        if constexpr (sizeof(T) == sizeof(std::int32_t)) {
            return a;
        } else {
            const batch_type half(T{1} << 31), bits((T{1} << 32) - 1);
            pack result;
            MYRIAD_EACH_BATCH(result.parts[i] = ((a.parts[i] + half) & bits) - half);
            return result;
        }
    }
};

}  // namespace myriad::inline MYRIAD_TARGET

namespace myriad::detail::inline MYRIAD_TARGET {

template <class T, int batches>
requires std::is_floating_point_v<T>
struct scalar_traits<pack<T, batches>> {
    using real = T;
    using mask = pack_mask<T, batches>;
    using integer = pack<detail::integer_of_width<T>, batches>;
    static constexpr int lanes = pack<T, batches>::lanes;
};

template <class T, int batches>
inline constexpr int kind_rank<pack<T, batches>> = 1;
template <class T, int batches>
inline constexpr int kind_rank<pack_mask<T, batches>> = 1;

}  // namespace myriad::detail::inline MYRIAD_TARGET

#include "myriad/kernel/scalar/pack_math.hpp"
#include "myriad/kernel/scalar/pack_normal_numbers.hpp"
