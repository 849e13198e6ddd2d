// SPDX-License-Identifier: MIT
// The size of an error estimate against the tolerances: the largest component, as in the MPGOS package.
#pragma once

#include "myriad/ensemble/view.hpp"
#include "myriad/stepper/explicit_rk.hpp"

namespace myriad::inline MYRIAD_TARGET {

template <class S>
struct error_norm {
    S worst;            // largest ratio of error to tolerance; NaN ratios do not enter
    mask_of<S> within;  // every ratio is at most one and every new value finite; false for NaN
};

/// Compares the error of each component with max(atol, rtol * max(|y|, |y1|)).
template <class Model, class Method, class S>
MYRIAD_FUNCTION error_norm<S> scaled_error(const kernel_arguments<Model, real_of<S>>& args,
                                           const vec<S, n_state<Model>>& y, const S& h,
                                           const rk_trial<Method, S, n_state<Model>>& trial) {
    using R = real_of<S>;
    error_norm<S> norm{S(R(0)), mask_of<S>(true)};
    MYRIAD_UNROLL
    for (int c = 0; c < n_state<Model>; ++c) {
        const S size = abs(trial.y[c]);
        const S scale = max(S(args.absolute_tolerance[c]), S(args.relative_tolerance[c]) * max(abs(y[c]), size));
        const S ratio = abs(error_estimate<Method>(h, trial.k, c)) / scale;
        norm.within = norm.within & (ratio <= S(R(1))) & (size <= S(largest_of<R>));
        norm.worst = select(ratio > norm.worst, ratio, norm.worst);
    }
    return norm;
}

}  // namespace myriad::inline MYRIAD_TARGET
