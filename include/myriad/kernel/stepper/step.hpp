// SPDX-License-Identifier: MIT
// The loop's interface to a method, explicit or implicit: a trial step, and the lanes in which it failed.
#pragma once

#include "myriad/kernel/stepper/explicit_rk.hpp"
#include "myriad/kernel/stepper/rosenbrock.hpp"
#include "myriad/kernel/stepper/rosenbrock_loop.hpp"
#include "myriad/kernel/stepper/stochastic_step.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Steps from (t, y) by h to t1, which is t + h up to rounding; `trial.slope_start()` must be set.
template <class Method, class Model, class S>
MYRIAD_FUNCTION void take_trial_step(const S& t, const S& h, const S& t1, const vec<S, n_state<Model>>& y,
                                     const inputs<Model, S>& p, trial_step<Method, S, n_state<Model>>& trial) {
    if constexpr (rosenbrock_method<Method>) {
        static_assert(n_tangent<Model> == 0 || !has_mass_matrix<Model>,
                      "with_tangents does not take a model with a mass_matrix, as tangents of algebraic states are not "
                      "independent: solve its algebraic equations in rhs");
        static_assert(!has_mass_matrix<Model> || is_stiffly_accurate<Method>,
                      "the model has a mass_matrix, which this method does not take, as its last stage is not the "
                      "solution: use rodas_5p");
        static_assert(mass_entries_fit<Model>,
                      "an entry of the model's mass_matrix has a row or a column that is no state");
        if constexpr (loops_over_stages<Method, Model, S>) {
            detail::rosenbrock_step_in_a_loop<Method, Model>(t, h, t1, y, p, trial);
        } else {
            detail::rosenbrock_step<Method, Model>(t, h, t1, y, p, trial);
        }
    } else if constexpr (stochastic_method<Method>) {
        static_assert(!has_mass_matrix<Model>,
                      "the model has a mass_matrix, which methods for stochastic equations do not take");
        detail::stochastic_step<Method, Model>(t, h, t1, y, p, trial);
    } else {
        static_assert(!has_mass_matrix<Model>,
                      "the model has a mass_matrix, which explicit methods do not take: use rodas_5p");
        constexpr bool in_memory = shared_step_bytes < Method, Model, S >> 0;
        detail::explicit_rk_step<Method, Model, in_memory>(t, h, t1, y, p, trial);
    }
}

/// Whether a method solves linear systems, which may be singular; its trial steps then mark the lanes, or, if it takes
/// fixed steps, have no number there.
template <class Method>
inline constexpr bool solves_linear_systems = rosenbrock_method<Method> || uses_jacobian<Method>;

}  // namespace myriad::detail::inline MYRIAD_TARGET
