// SPDX-License-Identifier: MIT
// Random numbers for hooks: a function of seed, instance, phase and number of the draw, with the same bits on every
// backend and on the host, in whatever order the work is done.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// Four 32-bit words: a counter, or the random bits computed from it.
using random_block = vec<std::uint32_t, 4>;

/// The number types that random numbers may have.
template <class R>
concept random_real = std::same_as<R, float> || std::same_as<R, double>;

/// Philox4x32-10, a bijection of the counters for every key: Salmon, Moraes, Dror and Shaw, "Parallel random numbers:
/// as easy as 1, 2, 3", SC11 (2011), section 3.3. Different counters, or keys, give independent bits. The low word of
/// `key` is key[0].
MYRIAD_FUNCTION random_block philox_4x32_10(random_block counter, std::uint64_t key) {
    std::uint32_t key_0 = static_cast<std::uint32_t>(key), key_1 = static_cast<std::uint32_t>(key >> 32);
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t a = std::uint64_t{0xd2511f53} * counter[0], b = std::uint64_t{0xcd9e8d57} * counter[2];
        counter = random_block{static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key_0, static_cast<std::uint32_t>(b),
                               static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key_1, static_cast<std::uint32_t>(a)};
        key_0 += 0x9e3779b9;
        key_1 += 0xbb67ae85;
    }
    return counter;
}

/// The midpoint of one of 2^52 equal parts of (0, 1): (2 k + 1) / 2^53, where k is the first 52 of the bits, word 1
/// before word 0. For float one of 2^23 parts: (2 k + 1) / 2^24. All are exact, none is 0 or 1, and u and 1 - u are
/// equally likely.
template <random_real R>
MYRIAD_FUNCTION R uniform_of(const random_block& bits) {
    constexpr int digits = std::numeric_limits<R>::digits;
    const std::uint64_t all = std::uint64_t{bits[1]} << 32 | bits[0];
    const std::uint64_t odd = all >> (64 - digits) | 1;
    return static_cast<R>(static_cast<std::int64_t>(odd)) * (R(1) / static_cast<R>(std::int64_t{1} << digits));
}

}  // namespace myriad::inline MYRIAD_TARGET

namespace myriad::detail::inline MYRIAD_TARGET {

/// Evaluates a polynomial with fused operations only.
template <class R>
MYRIAD_FUNCTION R fused_polynomial(R, double c0) {
    return static_cast<R>(c0);
}
template <class R, class... More>
MYRIAD_FUNCTION R fused_polynomial(R x, double c0, More... more) {
    return std::fma(x, fused_polynomial(x, more...), static_cast<R>(c0));
}

/// -log(x) for normal x below 1 / 2: x = m 2^e with m from 1/2 to 1, log(m) + log(2) / 2 = 2 artanh(s) by its series,
/// |s| < 0.172.
template <class R>
MYRIAD_FUNCTION R minus_log(R x) {
    constexpr R root_of_half = R(0.70710678118654752);
    int exponent = 0;
    const R m = std::frexp(x, &exponent);
    const R s = rounded_quotient(m - root_of_half, m + root_of_half);
    const R series = fused_polynomial(s * s, 2.0, 2.0 / 3, 2.0 / 5, 2.0 / 7, 2.0 / 9, 2.0 / 11, 2.0 / 13, 2.0 / 15,
                                      2.0 / 17, 2.0 / 19, 2.0 / 21, 2.0 / 23);
    return std::fma(static_cast<R>(exponent) - R(0.5), R(-0.69314718055994531), -(s * series));
}

}  // namespace myriad::detail::inline MYRIAD_TARGET

namespace myriad::inline MYRIAD_TARGET {

/// The inverse of the normal distribution function, for p in (0, 1); -infinity at 0, infinity at 1, NaN beyond:
/// Wichura's algorithm AS 241, PPND16, Appl. Statist. 37 (1988) 477-484. Relative error at most 1e-15 in double
/// precision, 1e-6 in single precision. Its bits are the same on every target, as it uses only fused operations,
/// integer operations, rounded quotients and square roots, which no compiler replaces. On processors without fused
/// operations the C library emulates them.
template <random_real R>
MYRIAD_FUNCTION R normal_quantile(R p) {
    using detail::fused_polynomial, detail::rounded_quotient;
    const R q = p - R(0.5);
    if (std::fabs(q) <= R(0.425)) {
        const R r = std::fma(-q, q, R(0.180625));
        return q * rounded_quotient(
                       fused_polynomial(r, 3.3871328727963666080, 1.3314166789178437745e2, 1.9715909503065514427e3,
                                        1.3731693765509461125e4, 4.5921953931549871457e4, 6.7265770927008700853e4,
                                        3.3430575583588128105e4, 2.5090809287301226727e3),
                       fused_polynomial(r, 1.0, 4.2313330701600911252e1, 6.8718700749205790830e2,
                                        5.3941960214247511077e3, 2.1213794301586595867e4, 3.9307895800092710610e4,
                                        2.8729085735721942674e4, 5.2264952788528545610e3));
    }
    const R tail = q < R(0) ? p : R(1) - p;  // exact
    if (!(tail > R(0))) return tail == R(0) ? q * infinity_of<R> : nan_of<R>;
    const R root = std::sqrt(detail::minus_log(tail));
    R x;
    if (root <= R(5)) {
        const R r = root - R(1.6);
        x = rounded_quotient(
            fused_polynomial(r, 1.42343711074968357734, 4.63033784615654529590, 5.76949722146069140550,
                             3.64784832476320460504, 1.27045825245236838258, 2.41780725177450611770e-1,
                             2.27238449892691845833e-2, 7.74545014278341407640e-4),
            fused_polynomial(r, 1.0, 2.05319162663775882187, 1.67638483018380384940, 6.89767334985100004550e-1,
                             1.48103976427480074590e-1, 1.51986665636164571966e-2, 5.47593808499534494600e-4,
                             1.05075007164441684324e-9));
    } else {
        const R r = root - R(5);
        x = rounded_quotient(
            fused_polynomial(r, 6.65790464350110377720, 5.46378491116411436990, 1.78482653991729133580,
                             2.96560571828504891230e-1, 2.65321895265761230930e-2, 1.24266094738807843860e-3,
                             2.71155556874348757815e-5, 2.01033439929228813265e-7),
            fused_polynomial(r, 1.0, 5.99832206555887937690e-1, 1.36929880922735805310e-1, 1.48753612908506148525e-2,
                             7.86869131145613259100e-4, 1.84631831751005468180e-5, 1.42151175831644588870e-7,
                             2.04426310338993978564e-15));
    }
    return q < R(0) ? -x : x;
}

/// The random numbers of one instance in one phase, in sequence, each from its own block of bits: counter (index, low
/// and high word; phase; number of the draw), key `seed`. No state outlives the hook: another hook of the same phase
/// must start at another number to get different ones; an event's hook, for example, at a number derived from the
/// event's count.
template <random_real R>
class random_numbers {
public:
    /// Draws of instance `index` in phase `phase`, from number `first` on.
    MYRIAD_FUNCTION random_numbers(std::uint64_t seed, std::int64_t index, std::int32_t phase, std::uint32_t first = 0)
        : seed_(seed), index_(static_cast<std::uint64_t>(index)), phase_(static_cast<std::uint32_t>(phase)),
          draw_(first) {}

    /// Uniform in (0, 1): see uniform_of.
    MYRIAD_FUNCTION R uniform() { return uniform_of<R>(next()); }
    /// Uniform between two numbers; because of rounding, either may be returned.
    MYRIAD_FUNCTION R uniform(R from, R to) { return std::fma(to - from, uniform(), from); }
    /// Normal with mean zero and variance one: normal_quantile of a uniform number, within +-8.3 (float 5.3).
    MYRIAD_FUNCTION R normal() { return normal_quantile(uniform()); }
    MYRIAD_FUNCTION R normal(R mean, R standard_deviation) { return std::fma(standard_deviation, normal(), mean); }

    /// The bits of the next draw.
    MYRIAD_FUNCTION random_block next() {
        return philox_4x32_10(
            random_block{static_cast<std::uint32_t>(index_), static_cast<std::uint32_t>(index_ >> 32), phase_, draw_++},
            seed_);
    }

private:
    std::uint64_t seed_, index_;
    std::uint32_t phase_, draw_;
};

}  // namespace myriad::inline MYRIAD_TARGET
