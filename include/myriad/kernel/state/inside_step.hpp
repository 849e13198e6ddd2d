// SPDX-License-Identifier: MIT
// An accepted step as those see it that watch the solution, and the evaluations beyond its stages that values inside it
// take: the slope at its end and the interpolant's own stages, each computed only where unknown, and counted.
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

/// Trial steps that are about to be committed, in the lanes where they were accepted: the state `s` is still that at
/// their start.
template <class Model, class Method, class S>
struct accepted_step {
    using mask = mask_of<S>;
    static constexpr auto n = n_state<Model>;

    integration_state<Model, Method, S>& s;
    const trial_step<Method, S, n>& trial;
    const S& t1;           // where they end
    const mask& accepted;  // in these lanes; the others do not count
    const mask& at_event;  // the step ends at an event

    /// Start, length and both states; of slopes, what is known.
    MYRIAD_FUNCTION step_data<Method, S, n> ends() const { return {s.now(), s.h, s.data.y, trial, s.slopes.end(), {}}; }
    /// The same with all that `interpolate` takes, in these lanes.
    MYRIAD_FUNCTION step_data<Method, S, n> inside(const mask& lanes) const {
        step_data<Method, S, n> step = ends();
        if constexpr (Method::first_same_as_last || interpolates_with_slope_end<Method>)
            detail::ensure_slope_end<Model>(s, step, t1, lanes);
        detail::ensure_interpolant<Model>(s, step, lanes);
        return step;
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
