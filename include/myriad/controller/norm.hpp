// SPDX-License-Identifier: MIT
// The size of an error estimate against the tolerances: the largest component, as in the MPGOS package, or their root mean
// square.
#pragma once

#include "myriad/controller/choices.hpp"
#include "myriad/controller/kind.hpp"
#include "myriad/ensemble/view.hpp"
#include "myriad/stepper/step.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// |error| / scale. In CUDA threads within 1e-6, over the whole range of S but for a scale that is subnormal.
template <class S>
MYRIAD_FUNCTION control_of<S> error_ratio(const S& error, const S& scale) {
#if defined(__CUDA_ARCH__)
    if constexpr (std::is_same_v<S, double>) {
        double reciprocal;
        asm("rcp.approx.ftz.f64 %0, %1;" : "=d"(reciprocal) : "d"(scale));
        return static_cast<float>(abs(error) * reciprocal);
    } else {
        return __fdividef(abs(error), scale);
    }
#else
    return static_cast<control_of<S>>(abs(error) / scale);
#endif
}

/// max(atol, rtol * max(|y|, |y1|)); NaN where one of these is. In CUDA threads within 2e-6: the larger of two magnitudes is
/// found by the upper halves of their bits, off the floating-point pipe, and the lower halves are left out.
template <class S>
MYRIAD_FUNCTION S larger_tolerance(const S& atol, const S& rtol, const S& y, const S& y1) {
#if defined(__CUDA_ARCH__)
    if constexpr (std::is_same_v<S, double>) {
        const int size = ::max(__double2hiint(y) & 0x7fffffff, __double2hiint(y1) & 0x7fffffff);
        const double relative = rtol * __hiloint2double(size, 0);
        return __hiloint2double(::max(__double2hiint(relative), __double2hiint(atol)), 0);
    }
#endif
    return larger(atol, rtol * larger(abs(y), abs(y1)));
}

template <class S>
struct error_norm {
    control_of<S> worst;  // largest ratio of error to tolerance; NaN ratios do not enter
    mask_of<S> within;    // every ratio is at most one and every new value finite; false for NaN
};

/// The largest of the components' ratios of `estimate(c)` to max(atol, rtol * max(|y|, |y1|)), or what was chosen instead.
template <class Model, class Method, class S, class Estimate>
MYRIAD_FUNCTION error_norm<S> error_over_tolerance(const kernel_arguments<Model, real_of<S>>& args,
                                                   const vec<S, n_state<Model>>& y, const vec<S, n_state<Model>>& y1,
                                                   Estimate&& estimate) {
    using C = control_of<S>;
    using R = real_of<C>;
    error_norm<S> norm{C(R(0)), mask_of<S>(true)};
    MYRIAD_UNROLL
    for (int c = 0; c < n_state<Model>; ++c) {
        const S atol = S(args.absolute_tolerance[c]), rtol = S(args.relative_tolerance[c]);
        S scale;
        if constexpr (adds_tolerances<Method>) {
            scale = fma(rtol, larger(abs(y[c]), abs(y1[c])), atol);
        } else {
            scale = larger_tolerance(atol, rtol, y[c], y1[c]);
        }
        C ratio = error_ratio(estimate(c), scale);
        // where the worst ratio is changed before it is judged, a NaN must not get lost
        if constexpr (has_coarse_estimate<Method> || scales_tolerances<Method>)
            ratio = select(ratio == ratio, ratio, C(infinity_of<R>));
        norm.within = norm.within & is_finite(y1[c]);
        if constexpr (averages_errors<Method>) {
            norm.worst = fma(ratio, ratio, norm.worst);
        } else {
            norm.within = norm.within & (ratio <= C(R(1)));
            norm.worst = select(ratio > norm.worst, ratio, norm.worst);
        }
    }
    if constexpr (averages_errors<Method>) {
        norm.worst = sqrt(norm.worst * C(R(1.0 / n_state<Model>)));
        norm.within = norm.within & (norm.worst <= C(R(1)));
    }
    return norm;
}

/// The size of a trial's error. Two estimates of orders q and q - 2 are combined into e_q^2 / sqrt(e_q^2 + 0.01 e_(q-2)^2),
/// which falls with h as one of order q + 2 (Hairer, Norsett, Wanner, Solving ODE I, II.10, for DOP853).
template <class Model, class Method, class S>
MYRIAD_FUNCTION error_norm<S> scaled_error(const kernel_arguments<Model, real_of<S>>& args,
                                           const vec<S, n_state<Model>>& y, const S& h,
                                           const rk_trial<Method, S, n_state<Model>>& trial) {
    error_norm<S> norm = error_over_tolerance<Model, Method>(
        args, y, trial.y, [&](int c) MYRIAD_LAMBDA { return error_estimate(h, trial, c); });
    if constexpr (has_coarse_estimate<Method>) {
        using C = control_of<S>;
        using R = real_of<C>;
        const C coarse = error_over_tolerance<Model, Method>(args, y, trial.y, [&](int c) MYRIAD_LAMBDA {
                             return error_estimate<Method, row_of<Method>::coarse_error>(h, trial.k, c);
                         }).worst;
        // sqrt(e^2 + 0.01 c^2), without overflow; the estimates of an exact step are both zero
        const C big = larger(norm.worst, C(R(0.1)) * coarse), small = smaller(norm.worst, C(R(0.1)) * coarse);
        const C quotient = select(big > C(R(0)), small / big, C(R(0)));
        const C length = big * sqrt(fma(quotient, quotient, C(R(1))));
        norm.worst = norm.worst * select(big > C(R(0)), norm.worst / length, C(R(0)));
        norm.within = (norm.worst <= C(R(1))) & (coarse <= C(largest_of<R>));  // an infinite one says nothing
        MYRIAD_UNROLL
        for (int c = 0; c < n_state<Model>; ++c) norm.within = norm.within & is_finite(trial.y[c]);
    }
    return norm;
}

}  // namespace myriad::inline MYRIAD_TARGET
