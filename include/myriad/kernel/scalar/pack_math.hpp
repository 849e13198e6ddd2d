// SPDX-License-Identifier: MIT
// The elementary functions of math.hpp for packs: xsimd's where they are accurate and treat every lane separately, our
// own otherwise. Lanes outside a function's vector range (huge angles, subnormal or special values) are redone one by
// one with the standard library, so that a lane's result never depends on its neighbours. Part of pack.hpp, which
// includes it.
//
// Largest errors measured with g++ 12 and xsimd 8.1, in ulp, double / float; 3 million arguments per range, against the
// next wider type, on AVX-512, on AVX2 with FMA and on SSE2:
//   sqrt 0.5 / 0.5      cbrt 0.8 / 0.9      hypot 1.2 / 1.2     min, max, abs, floor, round, copysign exact
//   sin, cos 1.5 / 1.5 (2.5 / 2.4 without FMA)   tan 2.9 / 2.8 (3.4 / 3.5)   sinpi, cospi 1.8 / 2.0
//   asin 1.2 / 2.4      acos 1.3 / 1.3      atan 2.0 / 2.3      atan2 2.3 / 2.6
//   sinh 1.6 / 2.1      cosh 1.3 / 2.0      tanh 1.3 / 1.4
//   exp 1.0 / 1.0       exp2 1.1 / 1.0      log 0.9 / 0.9       log2 1.8 / 1.9      log10 1.8 / 2.0
//   pow 1.2 / 1.2 up to |y| = 7, 1.5 / 1.5 at 30, 2.3 / 2.3 at 100, then growing with |y|
// Results of exp and exp2 below the smallest normal number are 0. Redone one by one: |x| > 2^30 in sin, cos,
// tan (float 2^16; without FMA 2^20 and 2^13), NaN and infinities there, arguments of log* below the smallest normal
// number, zeros and subnormal or non-finite numbers in cbrt and pow, results of pow out of range, zero or extreme
// hypot.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/batch.hpp"
#include "myriad/kernel/scalar/control_number.hpp"
#include "myriad/kernel/scalar/exponential.hpp"
#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/scalar/pack.hpp"
#include "myriad/kernel/scalar/standard_functions.hpp"
#include "myriad/kernel/scalar/trigonometry.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {
// Out of line, as it is rare and would be repeated in every stage; its name carries the instruction set like all
// others.
template <class Scalar, class S, class... More>
[[gnu::noinline, gnu::cold]] void redo_lanes(S& result, std::uint64_t lanes, const S& x, const More&... more) {
    for (; lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        set_lane(result, lane, Scalar::of(get_lane(x, lane), get_lane(more, lane)...));
    }
}

/// Replaces the marked lanes of a result by the results for plain reals.
template <class Scalar, class S, class Mask, class... More>
MYRIAD_FUNCTION S with_lanes_redone(const S& result, const Mask& marked, const More&... arguments) {
    if (MYRIAD_UNLIKELY(any(marked))) {
        // Copies, so that the caller's variables need no address and stay in registers.
        S redone = result;
        redo_lanes<Scalar>(redone, bits(marked), S(arguments)...);
        return redone;
    }
    return result;
}

template <class T, int batches>
struct functions<pack<T, batches>> {
    using S = pack<T, batches>;
    using mask = typename S::mask_type;

#define MYRIAD_SCALAR_UNARY(name)                          \
    struct scalar_##name {                                 \
        static T of(T x) { return functions<T>::name(x); } \
    };
#define MYRIAD_SCALAR_BINARY(name)                                 \
    struct scalar_##name {                                         \
        static T of(T x, T y) { return functions<T>::name(x, y); } \
    };

#define MYRIAD_UNARY(name, expression)                   \
    static MYRIAD_FUNCTION S name(const S& x) {          \
        S result;                                        \
        MYRIAD_EACH_BATCH(result.parts[i] = expression); \
        return result;                                   \
    }
#define MYRIAD_UNARY_WITH_REDO(name, expression, marked)            \
    MYRIAD_SCALAR_UNARY(name)                                       \
    static MYRIAD_FUNCTION S name(const S& x) {                     \
        S result;                                                   \
        MYRIAD_EACH_BATCH(result.parts[i] = expression);            \
        return with_lanes_redone<scalar_##name>(result, marked, x); \
    }
    MYRIAD_UNARY(sqrt, xsimd::sqrt(x.parts[i]))
    MYRIAD_UNARY(abs, xsimd::abs(x.parts[i]))
    MYRIAD_UNARY(reciprocal, xsimd::batch<T>(T(1)) / x.parts[i])
    MYRIAD_UNARY(rsqrt, xsimd::batch<T>(T(1)) / xsimd::sqrt(x.parts[i]))
    // Without SSE4.1, xsimd's floor loses the sign of zero; the bit operation restores it.
    MYRIAD_UNARY(floor, xsimd::floor(x.parts[i]) | (x.parts[i] & xsimd::batch<T>(-T(0))))
    MYRIAD_UNARY(round, xsimd::round(x.parts[i]))
    MYRIAD_UNARY(rint, xsimd::nearbyint(x.parts[i]) | (x.parts[i] & xsimd::batch<T>(-T(0))))
    MYRIAD_UNARY(asin, xsimd::asin(x.parts[i]))
    MYRIAD_UNARY(acos, xsimd::acos(x.parts[i]))
    MYRIAD_UNARY(atan, xsimd::atan(x.parts[i]))
    MYRIAD_UNARY(sinh, xsimd::sinh(x.parts[i]))
    MYRIAD_UNARY(cosh, xsimd::cosh(x.parts[i]))
    MYRIAD_UNARY(tanh, xsimd::tanh(x.parts[i]))
    MYRIAD_UNARY(expm1, xsimd::expm1(x.parts[i]))
    MYRIAD_UNARY(log1p, xsimd::log1p(x.parts[i]))
    MYRIAD_UNARY(exp, exponential<xsimd::batch<T>>::exp(x.parts[i]))
    MYRIAD_UNARY(exp2, exponential<xsimd::batch<T>>::exp2(x.parts[i]))
    MYRIAD_UNARY_WITH_REDO(sin, trigonometry<xsimd::batch<T>>::sin(x.parts[i]),
                           beyond(trigonometry_constants<T>::limit, x))
    MYRIAD_UNARY_WITH_REDO(cos, trigonometry<xsimd::batch<T>>::cos(x.parts[i]),
                           beyond(trigonometry_constants<T>::limit, x))
    MYRIAD_UNARY_WITH_REDO(tan, trigonometry<xsimd::batch<T>>::tan(x.parts[i]),
                           beyond(trigonometry_constants<T>::limit, x))
    MYRIAD_UNARY_WITH_REDO(sinpi, trigonometry<xsimd::batch<T>>::sinpi(x.parts[i]),
                           beyond(trigonometry<T>::half_turn_limit, x))
    MYRIAD_UNARY_WITH_REDO(cospi, trigonometry<xsimd::batch<T>>::cospi(x.parts[i]),
                           beyond(trigonometry<T>::half_turn_limit, x))
    MYRIAD_UNARY_WITH_REDO(cbrt,
                           xsimd::copysign(exponential<xsimd::batch<T>>::cbrt(xsimd::abs(x.parts[i])), x.parts[i]),
                           !(abs(x) >= S(smallest_normal) && is_finite(x)))
    MYRIAD_UNARY_WITH_REDO(log, exponential<xsimd::batch<T>>::log(x.parts[i]), x < S(smallest_normal))
    MYRIAD_UNARY_WITH_REDO(log2, exponential<xsimd::batch<T>>::log2(x.parts[i]), x < S(smallest_normal))
    MYRIAD_UNARY_WITH_REDO(log10, exponential<xsimd::batch<T>>::log10(x.parts[i]), x < S(smallest_normal))
#undef MYRIAD_UNARY_WITH_REDO
#undef MYRIAD_UNARY

#define MYRIAD_BINARY(name, expression)                     \
    static MYRIAD_FUNCTION S name(const S& a, const S& b) { \
        S result;                                           \
        MYRIAD_EACH_BATCH(result.parts[i] = expression);    \
        return result;                                      \
    }
    // x86 returns the second argument if one is NaN.
    MYRIAD_BINARY(min, xsimd::select(xsimd::isnan(b.parts[i]), a.parts[i], xsimd::min(a.parts[i], b.parts[i])))
    MYRIAD_BINARY(max, xsimd::select(xsimd::isnan(b.parts[i]), a.parts[i], xsimd::max(a.parts[i], b.parts[i])))
    MYRIAD_BINARY(copysign, xsimd::copysign(a.parts[i], b.parts[i]))
    MYRIAD_BINARY(raw_atan2, xsimd::atan2(a.parts[i], b.parts[i]))
    MYRIAD_BINARY(raw_hypot, xsimd::hypot(a.parts[i], b.parts[i]))
#undef MYRIAD_BINARY

    MYRIAD_SCALAR_BINARY(atan2)
    static MYRIAD_FUNCTION S atan2(const S& y, const S& x) {
        const S result = raw_atan2(y, x);  // NaN for (0, 0) and (inf, inf)
        return with_lanes_redone<scalar_atan2>(result, result != result, y, x);
    }
    MYRIAD_SCALAR_BINARY(hypot)
    static MYRIAD_FUNCTION S hypot(const S& x, const S& y) {
        const S result = raw_hypot(x, y);  // loses digits if a square overflows or underflows
        const mask kept = (result >= S(smallest_root)) & (result <= S(largest_root));
        return with_lanes_redone<scalar_hypot>(result, !kept, x, y);
    }
    MYRIAD_SCALAR_BINARY(pow)
    static MYRIAD_FUNCTION S pow(const S& x, const S& y) {
        S result;
        mask unfinished;
        MYRIAD_EACH_BATCH(unfinished.parts[i] =
                              exponential<xsimd::batch<T>>::pow(result.parts[i], x.parts[i], y.parts[i]));
        return with_lanes_redone<scalar_pow>(result, unfinished, x, y);
    }
    // The quotient cut towards zero is right or, rounded up, one too large; either way its remainder is a number of
    // this type, so that the fused operation is exact. Quotients that are no such number are for the standard library.
    MYRIAD_SCALAR_BINARY(fmod)
    static MYRIAD_FUNCTION S fmod(const S& x, const S& y) {
        const S size = abs(x), divisor = abs(y), quotient = size / divisor;
        const S rest = fma(-floor(quotient), divisor, size);
        const S result = copysign(select(rest < S(T(0)), rest + divisor, rest), x);
        const mask kept = (quotient < S(fused ? exact_integers : T(0))) & is_finite(y);
        return with_lanes_redone<scalar_fmod>(result, !kept, x, y);
    }
#undef MYRIAD_SCALAR_UNARY
#undef MYRIAD_SCALAR_BINARY

    static MYRIAD_FUNCTION S powr(const S& x, const S& y) {
        S result;
        MYRIAD_EACH_BATCH(result.parts[i] = exponential<xsimd::batch<T>>::powr(x.parts[i], y.parts[i]));
        return result;
    }
    static MYRIAD_FUNCTION void sincos(const S& x, S& sine, S& cosine) {
        MYRIAD_EACH_BATCH(trigonometry<xsimd::batch<T>>::sincos(x.parts[i], sine.parts[i], cosine.parts[i]));
    }
    static MYRIAD_FUNCTION void sincospi(const S& x, S& sine, S& cosine) {
        MYRIAD_EACH_BATCH(trigonometry<xsimd::batch<T>>::sincospi(x.parts[i], sine.parts[i], cosine.parts[i]));
    }

    static MYRIAD_FUNCTION S fma(const S& a, const S& b, const S& c) {
        S result;
        MYRIAD_EACH_BATCH(result.parts[i] = multiply_add(a.parts[i], b.parts[i], c.parts[i]));
        return result;
    }
    static MYRIAD_FUNCTION mask is_finite(const S& x) { return abs(x) <= S(std::numeric_limits<T>::max()); }

private:
    /// Lanes where |x| exceeds a limit or is NaN: one comparison of the bits for both.
    static MYRIAD_FUNCTION mask beyond(T limit, const S& x) {
        using integer = integer_of_width<T>;
        mask result;
        MYRIAD_EACH_BATCH(result.parts[i] = mask_cast<T>(bits_as<integer>(xsimd::abs(x.parts[i])) >
                                                         xsimd::batch<integer>(__builtin_bit_cast(integer, limit))));
        return result;
    }

    static constexpr bool is_double = sizeof(T) == sizeof(double);
    static constexpr bool fused = MYRIAD_FUSED;
    static constexpr T exact_integers = is_double ? T(0x1p53L) : T(0x1p24);  // below, all are numbers of this type
    static constexpr T smallest_normal = std::numeric_limits<T>::min();
    static constexpr T smallest_root = is_double ? T(0x1p-480L) : T(0x1p-50);
    static constexpr T largest_root = is_double ? T(0x1p500L) : T(0x1p60);
};

#if defined(__SSE2__)
// The comparison and selection of control_number.hpp are one x86 instruction, with the same results for NaN and signed
// zeros.
template <class T, int batches>
struct one_of_two<pack<T, batches>> {
    using S = pack<T, batches>;
    static MYRIAD_FUNCTION S larger(const S& a, const S& b) {
        S result;
        MYRIAD_EACH_BATCH(result.parts[i] = xsimd::max(a.parts[i], b.parts[i]));
        return result;
    }
    static MYRIAD_FUNCTION S smaller(const S& a, const S& b) {
        S result;
        MYRIAD_EACH_BATCH(result.parts[i] = xsimd::min(a.parts[i], b.parts[i]));
        return result;
    }
};
#endif

template <class T, int batches>
struct bit_comparison<pack<T, batches>> {
    using integer = integer_of_width<T>;
    static MYRIAD_FUNCTION auto differs(const pack<T, batches>& a, const pack<T, batches>& b) {
        typename pack<T, batches>::mask_type result;
        MYRIAD_EACH_BATCH(result.parts[i] = mask_cast<real_of_width<T>>(bits_as<integer>(a.parts[i]) !=
                                                                        bits_as<integer>(b.parts[i])));
        return result;
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
