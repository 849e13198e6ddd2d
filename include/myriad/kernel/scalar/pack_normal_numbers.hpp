// SPDX-License-Identifier: MIT
// The words and normal numbers of normal_numbers.hpp for packs. Part of pack.hpp, which includes it.
#pragma once

#include <concepts>
#include <cstdint>

#include "myriad/kernel/scalar/batch.hpp"
#include "myriad/kernel/scalar/normal_numbers.hpp"
#include "myriad/kernel/scalar/pack.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The product of a constant and the low half of each lane. xsimd has no such instruction.
template <std::same_as<std::uint64_t> T>
MYRIAD_FUNCTION xsimd::batch<T> multiply_low_halves(const xsimd::batch<T>& a, std::uint32_t by) {
    using batch = xsimd::batch<T>;
#if defined(__AVX512F__)
    return batch(_mm512_mul_epu32(a, _mm512_set1_epi64(by)));
#elif defined(__AVX2__)
    return batch(_mm256_mul_epu32(a, _mm256_set1_epi64x(by)));
#elif defined(__SSE2__)
    return batch(_mm_mul_epu32(a, _mm_set1_epi64x(by)));
#else
    std::uint64_t lanes[batch::size];
    a.store_unaligned(lanes);
    for (std::uint64_t& lane : lanes) lane = (lane & 0xffffffff) * by;
    return batch::load_unaligned(lanes);
#endif
}

/// In lanes of 64 bits, each in the low half of one.
template <std::same_as<double> T>
struct random_words<xsimd::batch<T>> {
    using B = xsimd::batch<T>;
    using word = xsimd::batch<std::uint64_t>;
    struct product {
        word high, low;
    };

    static MYRIAD_FUNCTION product multiply(const word& a, std::uint32_t by) {
        const word all = detail::multiply_low_halves(a, by);
        return {all >> 32, all};
    }
    static MYRIAD_FUNCTION B from_one_to_two(const word& low, const word& high) {
        const word bits = ((high << 20) & word(0x000fffff00000000u | 0xfff00000u)) | ((low >> 12) & word(0xfffffu));
        return bits_as<double>(bits | word(0x3ff0000000000000u));
    }
    static MYRIAD_FUNCTION B root(const B& x) { return xsimd::sqrt(x); }
    /// Bits 32 to 39 of a cell's number, from bit 24 on.
    static MYRIAD_FUNCTION word high_byte(const xsimd::batch<std::int64_t>& cell) {
        return (bits_as<std::uint64_t>(cell) >> 8) & word(0xff000000u);
    }
    static MYRIAD_FUNCTION word of(const xsimd::batch<std::int64_t>& a) { return bits_as<std::uint64_t>(a); }
};

/// In lanes of 32 bits.
template <std::same_as<float> T>
struct random_words<xsimd::batch<T>> {
    using B = xsimd::batch<T>;
    using word = xsimd::batch<std::uint32_t>;
    struct product {
        word high, low;
    };

    static MYRIAD_FUNCTION product multiply(const word& a, std::uint32_t by) {
        using wide = xsimd::batch<std::uint64_t>;
        const wide lanes = bits_as<std::uint64_t>(a);
        const wide even = detail::multiply_low_halves(lanes, by), odd = detail::multiply_low_halves(lanes >> 32, by);
        const wide low_half(0xffffffffu);
        return {bits_as<std::uint32_t>((even >> 32) | (odd & ~low_half)),
                bits_as<std::uint32_t>((even & low_half) | (odd << 32))};
    }
    static MYRIAD_FUNCTION B whole(const word& a) { return xsimd::to_float(bits_as<std::int32_t>(a)); }
    static MYRIAD_FUNCTION B with_sign_of(const B& x, const word& a) {
        return bits_as<float>(bits_as<std::uint32_t>(x) ^ (a & word(sign_bit)));
    }
    static MYRIAD_FUNCTION B root(const B& x) { return xsimd::sqrt(x); }
    static MYRIAD_FUNCTION word high_byte(const xsimd::batch<std::int32_t>&) { return word(0u); }
    static MYRIAD_FUNCTION word of(const xsimd::batch<std::int32_t>& a) { return bits_as<std::uint32_t>(a); }
};

template <class T, int batches>
struct path_integers<pack<T, batches>> {
    using cell = pack<integer_of_width<T>, batches>;
    using small = cell;
    using word = cell;
};

template <class T, int batches>
struct normals_of<pack<T, batches>> {
    using S = pack<T, batches>;
    static constexpr int count = normals_per_block<T>;

    static MYRIAD_FUNCTION vec<S, count> at(const block_place<S>& p, const philox_keys& keys) {
        using B = xsimd::batch<T>;
        using words = random_words<B>;
        using word = typename words::word;
        vec<S, count> all;
        MYRIAD_EACH_BATCH(word w[4] = {words::of(p.cell.parts[i]), words::of(p.owner.parts[i]),
                                       words::high_byte(p.cell.parts[i]) | (words::of(p.node.parts[i]) << 8) |
                                           word(static_cast<typename word::value_type>(p.group)),
                                       words::of(p.epoch.parts[i])};
                          B z[count]; detail::normal_numbers<B>(w, keys, z);
                          for (int k = 0; k < count; ++k) all[k].parts[i] = z[k]);
        return all;
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
