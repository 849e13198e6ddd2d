// SPDX-License-Identifier: MIT
// What a method for stochastic equations is.
#pragma once

namespace myriad::detail {

/// A method for stochastic equations says with which orders it converges, and takes one step by the functions of a
/// `noisy_equation` (stepper/stochastic_step.hpp):
///
///     strong_order, weak_order     with which a path and averages over paths converge
///     noise                        the pattern of noise that it takes
///     step(equation, t, h, t1, y, slope)
///                                  the state at t1, which is t + h up to rounding; `slope` is the drift at (t, y)
///
///     estimates_error              if `step` takes a last argument, into which it writes an estimate of its error: the
///                                  difference from a solution of strong order 1, which decreases like h^(3/2), in the
///                                  mean over what the path may do, for one more evaluation of the drift
///     uses_integrals               if it takes integrals of the path over a step, beside its increments
///     uses_jacobian                if it solves linear systems with the Jacobian of the drift
///
/// beside `stages`, the evaluations of the drift, embedded_order (0: fixed steps) and first_same_as_last (false).
template <class Method>
concept stochastic_method = requires {
    Method::strong_order;
    Method::weak_order;
    Method::noise;
};

}  // namespace myriad::detail

namespace myriad::detail {

/// Whether a method takes integrals of the path.
template <class Method>
inline constexpr bool uses_integrals = requires {
    requires Method::uses_integrals;
};

/// Whether a method solves linear systems with the Jacobian.
template <class Method>
inline constexpr bool uses_jacobian = requires {
    requires Method::uses_jacobian;
};

}  // namespace myriad::detail

namespace myriad {

/// The noise that a method takes.
enum class noise_taken {
    any,       ///< any diffusion
    additive,  ///< a diffusion that does not depend on the state
    diagonal,  ///< a Wiener process for each state, whose factor depends on no other state; or additive noise
};

}  // namespace myriad
