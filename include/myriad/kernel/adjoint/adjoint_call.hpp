// SPDX-License-Identifier: MIT
// What the adjoint of recorded steps works on, and what it computes.
#pragma once

#include <cstdint>

namespace myriad::detail {

/// The records of steps, the samples that are taken of them, and what is computed; Python's gradients/adjoint.py
/// has the same members.
/// Arrays of records are [record][instance], `values` and `weights` [instance][sample][quantity], `gradient`
/// [instance][state or chosen parameter].
struct adjoint_call {
    std::int64_t size;           ///< number of instances
    const std::int32_t* stored;  ///< number of records of each: the start, and the end of each step
    const double* time;
    const double* const* state;         ///< one array for each state
    const double* const* acted;         ///< one for each action: how often it acted before
    const double* const* acted_in_all;  ///< the same after the last record, by instance
    const double* const* parameter;     ///< one array for each parameter, by instance
    const double* shared;
    const std::int32_t* shared_integer;
    const double* sample_time;  ///< in the direction of time; null for one sample at the end, after actions there
    std::int64_t samples;
    double* values;         ///< for the quantities at the samples; null if the gradient is wanted
    const double* weights;  ///< the derivatives of the loss by these quantities
    double* gradient;       ///< for the derivatives of the loss by initial states and chosen parameters
};

}  // namespace myriad::detail
