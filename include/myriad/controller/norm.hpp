// SPDX-License-Identifier: MIT
// The size of an error estimate against the tolerances: the largest component, as in the MPGOS package.
#pragma once

#include <type_traits>

#include "myriad/ensemble/view.hpp"
#include "myriad/stepper/explicit_rk.hpp"

namespace myriad::inline MYRIAD_TARGET {

#if defined(__CUDACC__)
// The parameter is used for nothing but that nvcc 13 crashes if it is not.
/// The kind of number that says how large a step is to be, against the last one: single precision in CUDA threads, where
/// double is slow and division slowest, and seven digits are more than a step size needs.
template <class S>
using control_of = std::conditional_t<true, float, S>;
#else
template <class S>
using control_of = S;
#endif

/// The larger and the smaller of two numbers, the second where one is NaN: one instruction less on each side than max and min.
template <class S>
MYRIAD_FUNCTION S larger(const S& a, const S& b) {
    return select(a > b, a, b);
}
template <class S>
MYRIAD_FUNCTION S smaller(const S& a, const S& b) {
    return select(a < b, a, b);
}

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

template <class S>
struct error_norm {
    control_of<S> worst;  // largest ratio of error to tolerance; NaN ratios do not enter
    mask_of<S> within;  // every ratio is at most one and every new value finite; false for NaN
};

/// The largest of the components' ratios of error to max(atol, rtol * max(|y|, |y1|)).
template <int row, class Model, class Method, class S>
MYRIAD_FUNCTION error_norm<S> largest_ratio(const kernel_arguments<Model, real_of<S>>& args,
                                            const vec<S, n_state<Model>>& y, const S& h,
                                            const rk_trial<Method, S, n_state<Model>>& trial) {
    using C = control_of<S>;
    error_norm<S> norm{C(real_of<C>(0)), mask_of<S>(true)};
    MYRIAD_UNROLL
    for (int c = 0; c < n_state<Model>; ++c) {
        const S size = abs(trial.y[c]);
        const S scale = larger(S(args.absolute_tolerance[c]), S(args.relative_tolerance[c]) * larger(abs(y[c]), size));
        const C ratio = error_ratio(error_estimate<Method, row>(h, trial.k, c), scale);
        norm.within = norm.within & (ratio <= C(real_of<C>(1))) & (size <= S(largest_of<real_of<S>>));
        norm.worst = select(ratio > norm.worst, ratio, norm.worst);
    }
    return norm;
}

/// The size of a trial's error. Two estimates of orders q and q - 2 are combined into e_q^2 / sqrt(e_q^2 + 0.01 e_(q-2)^2),
/// which falls with h as one of order q + 2 (Hairer, Norsett, Wanner, Solving ODE I, II.10, for DOP853).
template <class Model, class Method, class S>
MYRIAD_FUNCTION error_norm<S> scaled_error(const kernel_arguments<Model, real_of<S>>& args,
                                           const vec<S, n_state<Model>>& y, const S& h,
                                           const rk_trial<Method, S, n_state<Model>>& trial) {
    error_norm<S> norm = largest_ratio<row_of<Method>::error, Model>(args, y, h, trial);
    if constexpr (has_coarse_estimate<Method>) {
        using C = control_of<S>;
        using R = real_of<C>;
        constexpr int coarse_row = row_of<Method>::coarse_error;
        const C coarse = largest_ratio<coarse_row, Model>(args, y, h, trial).worst;
        // sqrt(e^2 + 0.01 c^2), without overflow; the estimates of an exact step are both zero
        const C big = larger(norm.worst, C(R(0.1)) * coarse), small = smaller(norm.worst, C(R(0.1)) * coarse);
        const C quotient = select(big > C(R(0)), small / big, C(R(0)));
        const C length = big * sqrt(fma(quotient, quotient, C(R(1))));
        norm.worst = norm.worst * select(big > C(R(0)), norm.worst / length, C(R(0)));
        // Every stage that the estimates see is in the new state too, and makes it infinite or NaN.
        norm.within = norm.worst <= C(R(1));
        MYRIAD_UNROLL
        for (int c = 0; c < n_state<Model>; ++c) norm.within = norm.within & is_finite(trial.y[c]);
    }
    return norm;
}

}  // namespace myriad::inline MYRIAD_TARGET
