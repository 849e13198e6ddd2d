// SPDX-License-Identifier: MIT
// A method for stochastic equations with adaptive steps. A type of its own, so that kernels with fixed steps contain no
// code for it.
#pragma once

namespace myriad::detail {

/// Whether a method for stochastic equations estimates the error of its steps.
template <class Method>
inline constexpr bool estimates_error = requires {
    requires Method::estimates_error;
};

}  // namespace myriad::detail

namespace myriad {

/// `Method` for stochastic equations with steps that are halved until their errors are within the tolerances, and
/// doubled when the errors allow it; cells of the path (`options::noise_step`) are the longest. Instantiate it where
/// needed: `MYRIAD_INSTANTIATE(bistable, myriad::adaptive<myriad::sra1>)`.
template <class Method>
struct adaptive : Method {
    static_assert(detail::estimates_error<Method>,
                  "this method has no error estimate for adaptive steps: use adaptive<sra1> for additive noise or "
                  "adaptive<sriw1> for diagonal noise");
    static constexpr int stages = Method::stages + 1;  ///< one for the estimate
    static constexpr int embedded_order = 1;  ///< strong order of the solution with which that of the step is compared
};

}  // namespace myriad
