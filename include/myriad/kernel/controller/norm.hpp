// SPDX-License-Identifier: MIT
// The error estimate relative to the tolerances: the largest component, as in the MPGOS package, or the root mean
// square.
#pragma once

#include "myriad/kernel/methods/controller_policies.hpp"
#include "myriad/kernel/scalar/control_number.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"
#include "myriad/kernel/stepper/component_loop.hpp"
#include "myriad/kernel/stepper/step.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// |error| / scale. On GPUs within 1e-6, over the whole range of S except for a subnormal scale, and 0 if the
/// reciprocal of the scale is subnormal.
template <class S>
MYRIAD_FUNCTION S error_ratio(const S& error, const S& scale) {
#if MYRIAD_ON_GPU
    const S reciprocal = gpu::approximate_reciprocal(scale);
    return abs(error) * reciprocal;
#else
    return abs(error) / scale;
#endif
}

/// max(|a|, |b|) for a finite a; not finite if b is not.
template <class S>
MYRIAD_FUNCTION S larger_magnitude(const S& a, const S& b) {
    return larger(abs(a), abs(b));
}
/// max(a, b) for a non-negative number a; NaN if b is.
template <class S>
MYRIAD_FUNCTION S larger_scale(const S& a, const S& b) {
    return larger(a, b);
}
/// Whether `larger_scale` is NaN if either number is.
template <class S>
inline constexpr bool larger_scale_keeps_nan = false;
/// Whether a state that is not finite makes its ratio NaN without a separate check.
template <class S>
inline constexpr bool tells_infinity = false;

#if MYRIAD_ON_GPU
// The same on GPUs. In double precision the larger of two numbers by the upper halves of their bits, off the
// floating-point pipe: leaving out the lower halves changes a number by at most 1e-6 of its size.

template <>
inline constexpr bool tells_infinity<double> = true;
template <>
inline constexpr bool larger_scale_keeps_nan<double> = true;

MYRIAD_FUNCTION double larger_magnitude(const double& a, const double& b) {
    // with a lower half that turns infinity into NaN
    return gpu::from_halves(::max(gpu::upper_half(a) & 0x7fffffff, gpu::upper_half(b) & 0x7fffffff), 1);
}
/// As unsigned integers, the bits of a NaN are above the bits of infinity.
MYRIAD_FUNCTION double larger_scale(const double& a, const double& b) {
    const unsigned upper = ::max(static_cast<unsigned>(gpu::upper_half(a)), static_cast<unsigned>(gpu::upper_half(b)));
    return gpu::from_halves(static_cast<int>(upper), 0);
}

#if defined(MYRIAD_GPU_HAS_LARGER_OR_NAN)  // one instruction instead of a comparison, a selection and a sum that finds
                                           // NaN
template <>
inline constexpr bool larger_scale_keeps_nan<float> = true;

MYRIAD_FUNCTION float larger_scale(const float& a, const float& b) { return gpu::larger_or_nan(a, b); }
MYRIAD_FUNCTION float larger_magnitude(const float& a, const float& b) { return larger_scale(abs(a), abs(b)); }
#endif
#endif

/// The largest of non-negative numbers, one for each of a thread's n states, of which the whole system has `all`; NaN
/// if one of them is.
template <class Method, extent all, class S, extent n>
MYRIAD_FUNCTION S largest_ratio(const vec<S, n>& a) {
    S largest = a[0], sum = a[0];
    // The only state of a thread of a team is changed as those of others are: the same bits for every size of team.
    if constexpr (n == 1 && all > 1) largest = larger_scale(largest, largest);
    detail::each_component<Method, 1, n>([&](int c) MYRIAD_LAMBDA {
        largest = larger_scale(a[c], largest);
        sum = sum + a[c];
    });
    if constexpr (n == 1 || larger_scale_keeps_nan<S>) return largest;
    return select(sum == sum, largest, sum);
}

/// The values with which the errors of a trial are compared.
template <class S, extent n>
struct error_scale {
    vec<S, n> of;       // max(atol, rtol * max(|y|, |y1|)), or the chosen alternative
    mask_of<S> finite;  // no component of y1 is infinite; a NaN makes its ratio NaN
};
template <class Method, class Model, class S>
MYRIAD_FUNCTION error_scale<S, n_controlled<Model>> scale_of_errors(const kernel_arguments<Model, real_of<S>>& args,
                                                                    const vec<S, n_state<Model>>& y,
                                                                    const vec<S, n_state<Model>>& y1) {
    error_scale<S, n_controlled<Model>> scale;
    S largest = S(real_of<S>(0));  // may skip NaN
    detail::each_component<Method, n_controlled<Model>>([&](int c) MYRIAD_LAMBDA {
        const S atol = S(detail::absolute_tolerance_of(args, c)), rtol = S(detail::relative_tolerance_of(args, c));
        const S size = larger_magnitude(y[c], y1[c]);
        if constexpr (!tells_infinity<S>) largest = c == 0 ? size : larger_scale(largest, size);
        // Along a path, what is compared must not depend on where the path goes: else longer steps are taken where it
        // grows, and means over paths are off.
        const S compared = stochastic_method<Method> ? abs(y[c]) : size;
        if constexpr (adds_tolerances<Method>) {
            scale.of[c] = fma(rtol, compared, atol);
        } else {
            scale.of[c] = larger_scale(atol, rtol * compared);
        }
    });
    scale.finite = tells_infinity<S> ? mask_of<S>(true) : largest <= S(largest_of<real_of<S>>);
    if constexpr (n_uncontrolled < Model >> 0) {
        S others = S(real_of<S>(0));  // NaN if one of them is not finite
        detail::each_component<Method, n_controlled<Model>, n_state<Model>>(
            [&](int c) MYRIAD_LAMBDA { others = fma(S(real_of<S>(0)), y1[c], others); });
        scale.finite = scale.finite & (others == others);
    }
    return scale;
}

/// The largest |factor * sum(c)| / scale over the components of a thread, or the chosen norm of all; NaN if one of them
/// is.
template <class Model, class Method, class S, extent n, class Sum>
MYRIAD_FUNCTION control_of<S> error_over_tolerance(const vec<S, n>& scale, const S& factor, Sum&& sum) {
    using C = control_of<S>;
    constexpr auto all = n_controlled<whole_of<Model>>;  // components of the whole system
    if constexpr (averages_errors<Method>) {
        using R = real_of<C>;
        C squares = C(R(0));
        const auto ratio = [&](int c) MYRIAD_LAMBDA { return static_cast<C>(error_ratio(factor * sum(c), scale[c])); };
        const auto add = [&](const C& next) MYRIAD_LAMBDA { squares = fma(next, next, squares); };
        if constexpr (team_size<Model> == 1) {
            detail::each_component<Method, n>([&](int c) MYRIAD_LAMBDA { add(ratio(c)); });
        } else {
            as_part<Model>::template in_order<S>(ratio, add);
        }
        return sqrt(squares * C(R(1.0 / MYRIAD_LENGTH(all))));
    } else {
        vec<S, n> ratio;
        detail::each_component<Method, n>([&](int c) MYRIAD_LAMBDA { ratio[c] = error_ratio(sum(c), scale[c]); });
        return static_cast<C>(largest_ratio<Method, all>(ratio) * abs(factor));
    }
}

template <class S>
struct error_norm {
    control_of<S> worst;  // largest ratio of error to tolerance; NaN if one of them is
    mask_of<S> finite;    // no new value is infinite
};

/// The size of a trial's error. Two estimates of orders q and q - 2 are combined into e_q^2 / sqrt(e_q^2 + 0.01
/// e_(q-2)^2), which decreases with h like one of order q + 2 (Hairer, Norsett, Wanner, Solving ODE I, II.10, for
/// DOP853).
template <class Model, class Method, class S>
MYRIAD_FUNCTION error_norm<S> scaled_error(const kernel_arguments<Model, real_of<S>>& args,
                                           const vec<S, n_state<Model>>& y, const S& h,
                                           const trial_step<Method, S, n_state<Model>>& trial) {
    const auto scale = detail::scale_of_errors<Method, Model>(args, y, trial.y);
    const auto worst_of = [&](auto row) MYRIAD_LAMBDA {
        constexpr int weights = decltype(row)::value;
        return team_for<Model>::largest(error_over_tolerance<Model, Method>(
            scale.of, detail::error_factor<Method, weights>(h),
            [&](int c) MYRIAD_LAMBDA { return detail::error_sum<Method, weights>(trial, c); }));
    };
    error_norm<S> norm{worst_of(constant_index<row_of<Method>::error>{}), scale.finite};
    if constexpr (!tells_infinity<S>) norm.finite = team_for<Model>::all(norm.finite);
    if constexpr (has_coarse_estimate<Method>) {
        using C = control_of<S>;
        using R = real_of<C>;
        const C coarse = worst_of(constant_index<row_of<Method>::coarse_error>{});
        // e / sqrt(1 + (0.1 c / e)^2); both estimates of an exact step are zero
        const C steepness = quotient(C(R(0.1)) * coarse, norm.worst);
        const C combined = norm.worst * inverse_root(fma(steepness, steepness, C(R(1))));
        norm.worst = select(norm.worst > C(R(0)), combined, norm.worst);
        norm.finite = norm.finite & (coarse <= C(largest_of<R>));  // an infinite estimate tells nothing
    }
    return norm;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
