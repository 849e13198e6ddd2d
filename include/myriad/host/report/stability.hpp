// SPDX-License-Identifier: MIT
// How long the steps of an explicit method may be before they are unstable, and which methods are asked. Without the
// host side's types, for what is compiled with a model alone.
#pragma once

#include <cmath>

#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/stepper/step.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Whether steps of a method may be limited by stability.
template <class Method>
inline constexpr bool may_be_unstable =
    Method::embedded_order > 0 && !detail::solves_linear_systems<Method> && !detail::stochastic_method<Method>;
/// Whether a stiff method may be worth advising. Stiff methods do not support tangents.
template <class Model, class Method>
inline constexpr bool may_advise_stiff_methods =
    may_be_unstable<Method>&& detail::n_tangent<Model> == 0 && !detail::has_delays<Model>;

/// The stability function of an explicit method at a real z: the factor of one step for y' = z y / h. Hairer, Wanner,
/// Solving ODE II, IV.2, eq. (2.9).
template <class Method>
double stability_function(double z) {
    constexpr auto t = Method::tableau();
    double slope[Method::stages], y = 1;
    for (int i = 0; i < Method::stages; ++i) {
        double argument = 1;
        for (int j = 0; j < i; ++j) argument += z * t.weight(i, j) * slope[j];
        slope[i] = argument;
        y += z * t.weight(Method::stages, i) * argument;
    }
    return y;
}

/// The largest x such that steps are stable for y' = -z y / h with all z up to x.
template <class Method>
double real_stability_limit() {
    double x = 0.01;
    while (x < 100 && std::abs(stability_function<Method>(-x)) <= 1) x += 0.01;
    return x;
}

}  // namespace myriad::host::inline MYRIAD_ABI
