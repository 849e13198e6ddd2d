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

/// Compares the error of each component with max(atol, rtol * max(|y|, |y1|)).
template <class Model, class Method, class S>
MYRIAD_FUNCTION error_norm<S> scaled_error(const kernel_arguments<Model, real_of<S>>& args,
                                           const vec<S, n_state<Model>>& y, const S& h,
                                           const rk_trial<Method, S, n_state<Model>>& trial) {
    using C = control_of<S>;
    error_norm<S> norm{C(real_of<C>(0)), mask_of<S>(true)};
    MYRIAD_UNROLL
    for (int c = 0; c < n_state<Model>; ++c) {
        const S size = abs(trial.y[c]);
        const S scale = larger(S(args.absolute_tolerance[c]), S(args.relative_tolerance[c]) * larger(abs(y[c]), size));
        const C ratio = error_ratio(error_estimate<Method>(h, trial.k, c), scale);
        norm.within = norm.within & (ratio <= C(real_of<C>(1))) & (size <= S(largest_of<real_of<S>>));
        norm.worst = select(ratio > norm.worst, ratio, norm.worst);
    }
    return norm;
}

}  // namespace myriad::inline MYRIAD_TARGET
