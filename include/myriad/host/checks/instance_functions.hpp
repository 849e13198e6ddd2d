// SPDX-License-Identifier: MIT
// What checks and notes call of a model on the host, for single instances of an ensemble.
#pragma once

#include <cstdint>

#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad::detail {

/// Functions of a model and a method without their types; null where there is nothing to ask.
template <class R>
struct instance_functions {
    /// The slopes of instance i at time t in state y.
    void (*rhs)(const argument_head<R>&, std::int64_t i, R t, const R* y, R* slopes) = nullptr;
    /// The longest stable step for y' = -y; null where no stiff method can be advised.
    double (*stability_limit)() = nullptr;
    /// What rounding leaves of the event functions of instance i.
    void (*event_resolution)(const argument_head<R>&, std::int64_t i, R* finest) = nullptr;
    /// Throws `error` if the model's own Jacobian, or its pattern, is wrong in some of the first `count` instances.
    void (*check_jacobian)(const argument_head<R>&, std::int64_t count) = nullptr;
    /// The mass matrix of a model that has one, row by row.
    const double* mass_matrix = nullptr;
    /// The right-hand side of instance i at time t in state y, and its derivatives by the states, row by row.
    void (*linearise)(const argument_head<R>&, std::int64_t i, R t, const R* y, R* slopes, R* jacobian) = nullptr;
    /// Calls the model's `generate` for instances [begin, end).
    void (*generate)(const argument_head<R>&, std::uint64_t seed, std::int64_t begin, std::int64_t end) = nullptr;
};

/// The model's functions for the instances of these arguments.
template <class R>
struct single_instances {
    const instance_functions<R>& call;
    const argument_head<R>& arguments;
};

}  // namespace myriad::detail
