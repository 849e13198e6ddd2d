// SPDX-License-Identifier: MIT
// Alternatives to the default step-size control, chosen with the method. Each is a type, so that kernels contain no
// code for controls that were not chosen.
#pragma once

namespace myriad {

/// PI control: the step-size factor is 0.9 q^(-0.7/k) r^(0.4/k), with q and r the ratios of error to tolerance of this
/// and of the last accepted step and k the order of the error estimate plus one. Fewer rejections where stability
/// limits the step. Gustafsson, ACM Trans. Math. Softw. 17 (1991) 533; Hairer, Wanner, Solving ODE II, IV.2, eq.
/// (2.43c).
struct pi_control {
    static constexpr double exponent_now = 0.7;    ///< of this step's error, times -1 / k
    static constexpr double exponent_last = -0.4;  ///< of the last accepted step's error, times -1 / k
    static constexpr double exponent_before = 0;   ///< of the error of the step before that, times -1 / k
};

/// PID control: 0.9 q^(-0.58/k) r^(0.21/k) s^(-0.1/k), with s the ratio for the accepted step before the last. Kennedy
/// and Carpenter, Appl. Numer. Math. 44 (2003) 139; the constants are those of SUNDIALS' ARKODE.
struct pid_control {
    static constexpr double exponent_now = 0.58;    ///< as in `pi_control`
    static constexpr double exponent_last = -0.21;  ///< as in `pi_control`
    static constexpr double exponent_before = 0.1;  ///< as in `pi_control`
};

/// The root mean square of the components' ratios of error to tolerance, instead of the largest.
struct rms_norm {
    static constexpr bool averages_errors = true;  ///< how a method that has this choice is recognised
};

/// Errors are compared with atol + rtol max(|y|, |y1|), not with the larger of the two.
struct mixed_scale {
    static constexpr bool adds_tolerances = true;  ///< how a method that has this choice is recognised
};

/// If options::step is not given, the first step of a phase is computed from the slope and its change over a short
/// Euler step, and not from the slope alone, with two evaluations, one of which the first step reuses. Hairer, Norsett,
/// Wanner, Solving ODE I, II.4, "Starting step size".
struct automatic_first_step {
    static constexpr bool chooses_first_step = true;  ///< how a method that has this choice is recognised
};

/// Both tolerances are multiplied by `ensemble::tolerance_scale`, which may differ between instances.
struct tolerance_per_instance {
    static constexpr bool scales_tolerances = true;  ///< how a method that has this choice is recognised
};

/// The adaptive `Method` with the chosen controls. Instantiate it like any method, under a name of its own, as macro
/// arguments cannot contain commas: `using careful = controlled<dormand_prince_8, pi_control>;` and
/// `MYRIAD_INSTANTIATE(duffing, careful)`.
template <class Method, class... Choices>
struct controlled : Method, Choices... {
    static_assert(Method::embedded_order > 0, "the method takes fixed steps and has no step-size control to choose");
    static_assert((0 + ... + int(requires { Choices::exponent_last; })) + int(requires { Method::exponent_last; }) <= 1,
                  "a method has one controller: choose pi_control or pid_control");
};

}  // namespace myriad

namespace myriad::detail {

/// Whether a method's controller uses the errors of earlier steps.
template <class Method>
inline constexpr bool remembers_errors = requires {
    Method::exponent_last;
};
template <class Method>
inline constexpr bool averages_errors = requires {
    Method::averages_errors;
};
template <class Method>
inline constexpr bool adds_tolerances = requires {
    Method::adds_tolerances;
};
template <class Method>
inline constexpr bool chooses_first_step = requires {
    Method::chooses_first_step;
};
template <class Method>
inline constexpr bool scales_tolerances = requires {
    Method::scales_tolerances;
};

}  // namespace myriad::detail
