// SPDX-License-Identifier: MIT
// Evaluations beyond its stages that values inside an accepted step take: the slope at its end and the interpolant's
// own stages, each computed only where unknown, and counted.
#pragma once

#include "myriad/kernel/state/integration_state.hpp"
#include "myriad/kernel/stepper/dense_output.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Computes the slope at the end of the trial, at t1, in the given lanes. It is the first of the next step, unless a
/// hook changes the state; event location may have computed it already.
template <class Model, class Method, class S>
MYRIAD_FUNCTION void ensure_slope_end(integration_state<Model, Method, S>& s,
                                      step_data<Method, S, n_state<Model>>& step, const S& t1,
                                      const mask_of<S>& lanes) {
    if constexpr (Method::first_same_as_last) {
        step.slope_end = step.trial.slope_end();
    } else {
        step.slope_end = s.slopes.end(lanes, t1, step.trial.y, s.data, s.extra_evaluations);
    }
}

/// Computes the interpolant's own stages, after the slope at the end.
template <class Model, class Method, class S>
MYRIAD_FUNCTION void ensure_interpolant(integration_state<Model, Method, S>& s,
                                        step_data<Method, S, n_state<Model>>& step, const mask_of<S>& lanes) {
    if constexpr (extra_stages<Method> != 0) {
        detail::complete_interpolant<Model>(step, s.data);
        s.extra_evaluations = count_where(lanes, s.extra_evaluations, extra_stages<Method>);
    }
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
