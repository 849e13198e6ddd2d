// SPDX-License-Identifier: MIT
// The contract of a stepper: what takes the steps of a method. Explicit Runge-Kutta and Rosenbrock methods are two.
#pragma once

#include <concepts>

#include "myriad/kernel/stepper/dense_output.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// What the loop and its parts use of a method's steps, and nothing beyond it:
///
/// The proposal. The controller says from where to where: (t, y), h, and t1, which is t + h up to rounding.
///
/// The trial. A `trial_step<Method, S, n>`, in which the loop sets `slope_start()`, the right-hand side at (t, y), and
/// `take_trial_step<Method, Model>` all else: the new state `y`; if the method is `first_same_as_last`, `slope_end()`,
/// the right-hand side at (t1, y); and if it solves linear systems, the lanes that are `singular`, where the rest is
/// invalid, or with fixed steps is not a number. `Method::stages` are the evaluations of the right-hand side, that at
/// the start included.
///
/// The error, of methods with an `embedded_order`. The estimate of component c is `error_factor<Method>(h) *
/// error_sum<Method>(trial, c)`; it decreases with h to the power `estimate_order<Method> + 1`.
///
/// The interpolant. `interpolate(step, theta)` is the state at t + theta h, with a dual theta its derivative too. A
/// `step_data` has the trial and what the interpolant needs beyond it: the slope at the end if it
/// `interpolates_with_slope_end`, and `extra_stages`, which `complete_interpolant` computes.
///
/// Another try. A trial writes to nothing but the `trial_step`, and depends on nothing that an earlier trial has left:
/// the loop takes it again, by the same h or a shorter one, where it was rejected, where the step is to end at an
/// event, and where the threads of a warp wait for each other.
template <class Method, class Model, class S>
concept stepper = requires(const S& t, const vec<S, n_state<Model>>& y, const inputs<Model, S>& p,
                           trial_step<Method, S, n_state<Model>>& trial,
                           const trial_step<Method, S, n_state<Model>>& taken,
                           step_data<Method, S, n_state<Model>>& step) {
    { Method::stages } -> std::convertible_to<int>;
    { Method::first_same_as_last } -> std::convertible_to<bool>;
    { Method::embedded_order } -> std::convertible_to<int>;
    { trial.slope_start() } -> std::same_as<vec<S, n_state<Model>>&>;
    { taken.slope_start() } -> std::same_as<const vec<S, n_state<Model>>&>;
    { taken.y } -> std::same_as<const vec<S, n_state<Model>>&>;
    requires !Method::first_same_as_last || requires {
        { taken.slope_end() } -> std::same_as<const vec<S, n_state<Model>>&>;
    };
    requires !solves_linear_systems<Method> || Method::embedded_order <= 0 || requires {
        { taken.singular } -> std::same_as<const mask_of<S>&>;
    };
    requires Method::embedded_order <= 0 || requires {
        { detail::error_factor<Method>(t) } -> std::same_as<S>;
        { detail::error_sum<Method>(taken, 0) } -> std::same_as<S>;
    };
    detail::take_trial_step<Method, Model>(t, t, t, y, p, trial);
    detail::complete_interpolant<Model>(step, p);
    { detail::interpolate(step, t) } -> std::same_as<vec<S, n_state<Model>>>;
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
