// SPDX-License-Identifier: MIT
// Operations on one SIMD batch that packs need and that xsimd (8 to 13) lacks, changes between versions, or gets wrong.
#pragma once

#include <cstdint>
#include <limits>
#include <type_traits>

// g++ 12 warns of deliberately uninitialised registers in its own AVX-512 intrinsics (GCC bug 105593).
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <xsimd/xsimd.hpp>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/arithmetic.hpp"
#include "myriad/kernel/scalar/math.hpp"

// Repeats a statement for i = 0, 1, ... of a pack's batches. Not a loop: g++ unrolls loops after other optimisations,
// and would then fuse different products and sums depending on the number of batches.
#define MYRIAD_EACH_BATCH(...)       \
    do {                             \
        {                            \
            constexpr int i = 0;     \
            __VA_ARGS__;             \
        }                            \
        if constexpr (batches > 1) { \
            constexpr int i = 1;     \
            __VA_ARGS__;             \
        }                            \
        if constexpr (batches > 2) { \
            constexpr int i = 2;     \
            __VA_ARGS__;             \
        }                            \
        if constexpr (batches > 3) { \
            constexpr int i = 3;     \
            __VA_ARGS__;             \
        }                            \
    } while (false)

namespace myriad::detail::inline MYRIAD_TARGET {
template <class T>
using real_of_width = std::conditional_t<sizeof(T) == sizeof(double), double, float>;
template <class T>
using integer_of_width = std::conditional_t<sizeof(T) == sizeof(double), std::int64_t, std::int32_t>;

// AVX-512 keeps a mask as bits in a register, other instruction sets as a vector whose lanes are all ones or zero.
template <class Batch>
inline constexpr bool has_bit_mask = std::is_integral_v<typename Batch::register_type>;

/// The lanes of a batch_bool as bits, not through memory if the hardware has an instruction for it.
template <class T>
MYRIAD_FUNCTION std::uint64_t bits_of(const xsimd::batch_bool<T>& mask) {
    using batch_bool = xsimd::batch_bool<T>;
    using register_type = typename batch_bool::register_type;
    if constexpr (requires { mask.mask(); }) {
        return static_cast<std::uint64_t>(mask.mask());
    } else if constexpr (has_bit_mask<batch_bool>) {
        return static_cast<std::uint64_t>(static_cast<register_type>(mask));
    } else {
#if defined(__AVX__)
        if constexpr (sizeof(register_type) == sizeof(__m256d)) {
            const register_type r = mask;
            if constexpr (sizeof(T) == sizeof(double)) {
                return static_cast<std::uint64_t>(_mm256_movemask_pd(r));
            } else {
                return static_cast<std::uint64_t>(_mm256_movemask_ps(r));
            }
        }
#endif
#if defined(__SSE2__)
        if constexpr (sizeof(register_type) == sizeof(__m128d)) {
            const register_type r = mask;
            if constexpr (sizeof(T) == sizeof(double)) {
                return static_cast<std::uint64_t>(_mm_movemask_pd(r));
            } else {
                return static_cast<std::uint64_t>(_mm_movemask_ps(r));
            }
        }
#endif
        bool lanes[batch_bool::size];
        mask.store_unaligned(lanes);
        std::uint64_t result = 0;
        for (std::size_t i = 0; i < batch_bool::size; ++i) result |= static_cast<std::uint64_t>(lanes[i]) << i;
        return result;
    }
}

/// The same mask for another type of the same width. xsimd's own cast changed its name between versions.
template <class To, class From>
MYRIAD_FUNCTION xsimd::batch_bool<To> mask_cast(const xsimd::batch_bool<From>& mask) {
    using from_register = typename xsimd::batch_bool<From>::register_type;
    using to_register = typename xsimd::batch_bool<To>::register_type;
    return xsimd::batch_bool<To>(__builtin_bit_cast(to_register, static_cast<from_register>(mask)));
}

/// Calls f with the registers of masks, as integers on which the compiler can compute and fold. g++ cannot see through
/// xsimd's operations on vector masks: a negation, or a mask known to be all true, costs two more instructions.
template <int bytes>
struct register_bits {
    typedef long long type __attribute__((vector_size(bytes)));
};
template <class F, class B, class... More>
MYRIAD_FUNCTION B join_masks(F&& f, const B& a, const More&... more) {
    using register_type = typename B::register_type;
    if constexpr (has_bit_mask<B>) {
        return B(static_cast<register_type>(f(static_cast<register_type>(a), static_cast<register_type>(more)...)));
    } else {
        using integers = typename register_bits<sizeof(register_type)>::type;
        return B(
            __builtin_bit_cast(register_type, f(__builtin_bit_cast(integers, static_cast<register_type>(a)),
                                                __builtin_bit_cast(integers, static_cast<register_type>(more))...)));
    }
}

/// Reinterprets the bits of a batch as another type of the same width.
template <class To, class From>
MYRIAD_FUNCTION xsimd::batch<To> bits_as(const xsimd::batch<From>& x) {
    using from_register = typename xsimd::batch<From>::register_type;
    using to_register = typename xsimd::batch<To>::register_type;
    return xsimd::batch<To>(__builtin_bit_cast(to_register, static_cast<from_register>(x)));
}

/// a * b + c, a * b - c and c - a * b with one rounding if the target supports it (MYRIAD_FUSED). xsimd 8 has none for
/// AVX-512: it writes a * b + c and leaves the fusing to the compiler.
#if defined(__AVX512F__)
#define MYRIAD_FUSED_OPERATION(name, xsimd_name, intrinsic)                                  \
    template <class T>                                                                       \
    MYRIAD_FUNCTION xsimd::batch<T> name(const xsimd::batch<T>& a, const xsimd::batch<T>& b, \
                                         const xsimd::batch<T>& c) {                         \
        if constexpr (std::is_same_v<T, double>) {                                           \
            return xsimd::batch<T>(intrinsic##_pd(a, b, c));                                 \
        } else {                                                                             \
            return xsimd::batch<T>(intrinsic##_ps(a, b, c));                                 \
        }                                                                                    \
    }
#else
#define MYRIAD_FUSED_OPERATION(name, xsimd_name, intrinsic)                                  \
    template <class T>                                                                       \
    MYRIAD_FUNCTION xsimd::batch<T> name(const xsimd::batch<T>& a, const xsimd::batch<T>& b, \
                                         const xsimd::batch<T>& c) {                         \
        return xsimd::xsimd_name(a, b, c);                                                   \
    }
#endif
MYRIAD_FUSED_OPERATION(multiply_add, fma, _mm512_fmadd)
MYRIAD_FUSED_OPERATION(multiply_subtract, fms, _mm512_fmsub)
MYRIAD_FUSED_OPERATION(subtract_product, fnma, _mm512_fnmadd)
#undef MYRIAD_FUSED_OPERATION

template <class T>
struct arithmetic<xsimd::batch<T>> {
    using real = T;
    using B = xsimd::batch<T>;
    using mask = xsimd::batch_bool<T>;
    using bits = xsimd::batch<typename arithmetic<T>::bits>;

    static MYRIAD_FUNCTION B multiply_add(const B& a, const B& b, const B& c) { return detail::multiply_add(a, b, c); }
    static MYRIAD_FUNCTION B multiply_subtract(const B& a, const B& b, const B& c) {
        return detail::multiply_subtract(a, b, c);
    }
    static MYRIAD_FUNCTION B subtract_product(const B& a, const B& b, const B& c) {
        return detail::subtract_product(a, b, c);
    }
    static MYRIAD_FUNCTION B select(const mask& m, const B& a, const B& b) { return xsimd::select(m, a, b); }
    static MYRIAD_FUNCTION B abs(const B& x) { return xsimd::abs(x); }
    static MYRIAD_FUNCTION B floor(const B& x) { return xsimd::floor(x); }
    static MYRIAD_FUNCTION bits to_bits(const B& x) { return bits_as<typename arithmetic<T>::bits>(x); }
    static MYRIAD_FUNCTION B from_bits(const bits& b) { return bits_as<T>(b); }
    static MYRIAD_FUNCTION mask is_odd(const bits& b) {
        using unsigned_bits = typename arithmetic<T>::bits;
        if constexpr (has_bit_mask<mask>) {
            return mask_cast<T>((b & bits(unsigned_bits{1})) != bits(unsigned_bits{0}));
        } else {
            // By the sign bit: a comparison with zero would need a negation.
            using integer = integer_of_width<T>;
            return mask_cast<T>(bits_as<integer>(b << static_cast<int>(8 * sizeof(T) - 1)) <
                                xsimd::batch<integer>(integer{0}));
        }
    }
    static MYRIAD_FUNCTION B reciprocal(const B& x) { return B(T(1)) / x; }
    static MYRIAD_FUNCTION mask is_finite_from(T least, const B& x) {
        return (x >= B(least)) & (x <= B(std::numeric_limits<T>::max()));
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
