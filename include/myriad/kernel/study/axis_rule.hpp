// SPDX-License-Identifier: MIT
// The values that instances of a study have along its axes, as a function of the instance's number: the same bits on
// the host and on a GPU, so that neither must be told the other's.
#pragma once

#include <cmath>
#include <cstdint>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/model/random.hpp"

namespace myriad::detail {

enum class axis_kind : std::int32_t {
    linear,       // first + i step; the last value exactly
    logarithmic,  // with a constant ratio
    table,        // as listed
    uniform,      // random from first to last
    normal,       // random with mean first and standard deviation last
};

/// The values of one component in all instances. Plain data; an ensemble's value for all is an axis of length 1.
struct axis_rule {
    axis_kind kind = axis_kind::linear;
    std::uint32_t draw = 0;                // the number of a random value's draw: one for each component
    std::int64_t length = 1, stride = 1;   // values, and instances from one to the next
    double first = 0, last = 0, step = 0;  // `step`: from value to value, of the logarithm if logarithmic
    double first_log = 0;
    const double* table = nullptr;  // where the one who computes can read it
};

/// In place of the phase that hooks have: random values of axes and of a model's `generate`, which are no hooks.
inline constexpr std::int32_t phase_of_axes = -1, phase_of_generator = -2;

}  // namespace myriad::detail

namespace myriad::detail::inline MYRIAD_TARGET {

/// e^x for x within +-745, in the last place or two. Its bits are the same on every target, as those of
/// `normal_quantile`. The C library's and CUDA's exponentials differ in bits. The series is from exponential.hpp.
MYRIAD_FUNCTION double exp_everywhere(double x) {
    constexpr double log2_e = 0x1.71547652b82fep+0, whole = 0x1.8p52;  // adding `whole` rounds to an integer
    constexpr double ln_2_head = 0x1.62e42fefa38p-1, ln_2_rest = 0x1.ef35793c7673p-45;
    const double k = std::fma(x, log2_e, whole) - whole;
    const double r = std::fma(-k, ln_2_rest, std::fma(-k, ln_2_head, x));
    const double tail =
        fused_polynomial(r, 0x1.0000000000009p-1, 0x1.55555555554fbp-3, 0x1.5555555550b41p-5, 0x1.1111111127a0fp-7,
                         0x1.6c16c183ae6d5p-10, 0x1.a01a012a154a9p-13, 0x1.a0199b23c79b6p-16, 0x1.71df273cfabb2p-19,
                         0x1.28ac95d083d89p-22, 0x1.ad7aeaef8144ep-26);
    return std::ldexp(1 + std::fma(r * r, tail, r), static_cast<int>(k));
}

/// Value i of the axis; not of a random one.
MYRIAD_FUNCTION double value_on_axis(const axis_rule& axis, std::int64_t i) {
    if (axis.kind == axis_kind::table) return axis.table[i];
    if (i == 0) return axis.first;
    if (i == axis.length - 1) return axis.last;
    const auto at = static_cast<double>(i);
    if (axis.kind == axis_kind::linear) return axis.first + MYRIAD_ROUNDED_PRODUCT(at, axis.step);
    return std::copysign(exp_everywhere(axis.first_log + MYRIAD_ROUNDED_PRODUCT(at, axis.step)), axis.first);
}

/// Which value along the axis an instance has.
MYRIAD_FUNCTION std::int64_t place_on_axis(const axis_rule& axis, std::int64_t instance) {
    if (axis.length == 1) return 0;
    // Divisions of 64 bits take a GPU several times as long.
    if (((instance | axis.stride | axis.length) >> 32) == 0) {
        const auto i = static_cast<std::uint32_t>(instance), stride = static_cast<std::uint32_t>(axis.stride);
        return i / stride % static_cast<std::uint32_t>(axis.length);
    }
    return instance / axis.stride % axis.length;
}

/// The value in an instance of the study. A random one depends on the seed, the component and the instance alone.
MYRIAD_FUNCTION double value_in_instance(const axis_rule& axis, std::uint64_t seed, std::int64_t instance) {
    if (axis.kind == axis_kind::uniform || axis.kind == axis_kind::normal) {
        random_numbers<double> random(seed, instance, phase_of_axes, axis.draw);
        return axis.kind == axis_kind::uniform ? random.uniform(axis.first, axis.last)
                                               : random.normal(axis.first, axis.last);
    }
    return detail::value_on_axis(axis, detail::place_on_axis(axis, instance));
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
